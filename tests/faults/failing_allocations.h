#ifndef MESHGROW_TESTS_FAILING_ALLOCATIONS_H
#define MESHGROW_TESTS_FAILING_ALLOCATIONS_H

#include <cstddef>

namespace meshgrow::test {

/// For the life of this object the n-th allocation (from 1) fails, counted over all threads; with
/// `and_all_later`, those after it as well. 0: none fails, they are only counted. Only allocations
/// that the program itself asks for, directly or through the standard library, count: not those of
/// shared libraries. One object at a time.
class FailingAllocations {
 public:
  explicit FailingAllocations(std::size_t n, bool and_all_later = false);
  ~FailingAllocations();
  FailingAllocations(const FailingAllocations&) = delete;
  FailingAllocations& operator=(const FailingAllocations&) = delete;

  /// Up to now.
  static std::size_t seen();
};

/// Allocations by `new` that were not deleted yet, of the whole process.
std::size_t living_allocations();

}  // namespace meshgrow::test

#endif
