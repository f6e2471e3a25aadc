#ifndef MESHGROW_AVAILABLE_MEMORY_H
#define MESHGROW_AVAILABLE_MEMORY_H

#include <cstddef>

namespace meshgrow {

/// Bytes that this process can still take without pushing others out: what the system has left, and
/// no more than its control group, a limit of its address space (ulimit -v) or of its data leaves.
/// As it is at the moment; 1 GiB where nothing is told. Thread-safe.
std::size_t available_memory();

}  // namespace meshgrow

#endif
