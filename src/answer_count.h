#ifndef MESHGROW_ANSWER_COUNT_H
#define MESHGROW_ANSWER_COUNT_H

#include <array>
#include <atomic>
#include <cstdint>

namespace meshgrow {

/// Counts the sizes answered, by who answers. Threads have counters of their own, or they would
/// wait for each other at each size.
class AnswerCount {
 public:
  enum Who { grid, exact };

  void add(Who who, std::uint64_t count = 1) {
    stripes_[own_stripe()].count[who].fetch_add(count, std::memory_order_relaxed);
  }

  std::uint64_t total(Who who) const {
    std::uint64_t sum = 0;
    for (const Stripe& stripe : stripes_) {
      sum += stripe.count[who].load(std::memory_order_relaxed);
    }
    return sum;
  }

 private:
  struct alignas(64) Stripe {
    std::array<std::atomic<std::uint64_t>, 2> count{};
  };
  static constexpr unsigned stripe_count = 16;

  static unsigned own_stripe() {
    static std::atomic<unsigned> threads{0};
    thread_local const unsigned own = threads++ % stripe_count;
    return own;
  }

  std::array<Stripe, stripe_count> stripes_;
};

}  // namespace meshgrow

#endif
