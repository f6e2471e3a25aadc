#include "failing_allocations.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" void* __real_malloc(std::size_t size);

namespace meshgrow::test {

namespace {

std::atomic<bool> armed{false};
std::atomic<std::size_t> seen_count{0};
std::atomic<std::size_t> first_to_fail{0};
std::atomic<bool> later_fail{false};
std::atomic<std::size_t> living{0};
thread_local bool is_looking = false;

struct AddressRange {
  std::uintptr_t begin = UINTPTR_MAX;
  std::uintptr_t end = 0;
  bool contains(const void* address) const {
    const auto place = reinterpret_cast<std::uintptr_t>(address);
    return begin <= place && place < end;
  }
};

/// Where the code of the program, or of the standard library, is.
AddressRange range_of(bool of_program) {
  struct Search {
    bool of_program;
    AddressRange range;
  } search{of_program, {}};
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        auto& wanted = *static_cast<Search*>(data);
        const bool is_program = *info->dlpi_name == '\0';
        const bool is_standard = std::strstr(info->dlpi_name, "/libstdc++.so") != nullptr;
        if (wanted.of_program ? !is_program : !is_standard) {
          return 0;
        }
        for (int i = 0; i < info->dlpi_phnum; ++i) {
          if (info->dlpi_phdr[i].p_type == PT_LOAD) {
            const std::uintptr_t begin = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
            wanted.range.begin = std::min(wanted.range.begin, begin);
            wanted.range.end = std::max(wanted.range.end, begin + info->dlpi_phdr[i].p_memsz);
          }
        }
        return 1;
      },
      &search);
  return search.range;
}

/// Whether the first caller that is not of the standard library is of the program.
__attribute__((noinline)) bool is_asked_for_by_program() {
  static const AddressRange program = range_of(true);
  static const AddressRange standard = range_of(false);
  std::array<void*, 16> callers = {};
  const int count = backtrace(callers.data(), static_cast<int>(callers.size()));
  // The first three are this function, the one that decides, and `new` or `malloc` itself.
  for (int i = 3; i < count; ++i) {
    if (!standard.contains(callers[static_cast<std::size_t>(i)])) {
      return program.contains(callers[static_cast<std::size_t>(i)]);
    }
  }
  return false;
}

__attribute__((noinline)) bool shall_fail() {
  if (!armed || is_looking) {
    return false;
  }
  is_looking = true;  // looking may allocate
  const bool counts = is_asked_for_by_program();
  is_looking = false;
  if (!counts) {
    return false;
  }
  const std::size_t number = ++seen_count;
  return number == first_to_fail || (later_fail && number > first_to_fail && first_to_fail > 0);
}

}  // namespace

FailingAllocations::FailingAllocations(std::size_t n, bool and_all_later) {
  std::array<void*, 1> unused = {};
  backtrace(unused.data(), 1);  // the first call loads what it needs
  first_to_fail = n;
  later_fail = and_all_later;
  seen_count = 0;
  armed = true;
}

FailingAllocations::~FailingAllocations() { armed = false; }

std::size_t FailingAllocations::seen() { return seen_count; }

std::size_t living_allocations() { return living; }

}  // namespace meshgrow::test

using meshgrow::test::living;
using meshgrow::test::shall_fail;

extern "C" __attribute__((noinline)) void* __wrap_malloc(std::size_t size) {
  return shall_fail() ? nullptr : __real_malloc(size);
}

__attribute__((noinline)) void* operator new(std::size_t size) {
  void* memory = shall_fail() ? nullptr : __real_malloc(size > 0 ? size : 1);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  ++living;
  return memory;
}

__attribute__((noinline)) void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  void* memory = shall_fail() ? nullptr : std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  ++living;
  return memory;
}

__attribute__((noinline)) void* operator new[](std::size_t size) {
  void* memory = shall_fail() ? nullptr : __real_malloc(size > 0 ? size : 1);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  ++living;
  return memory;
}

void operator delete(void* memory) noexcept {
  if (memory != nullptr) {
    --living;
    std::free(memory);
  }
}
void operator delete[](void* memory) noexcept { operator delete(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { operator delete(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { operator delete(memory); }
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
  operator delete(memory);
}
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  operator delete(memory);
}
