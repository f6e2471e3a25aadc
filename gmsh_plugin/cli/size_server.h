#ifndef MESHGROW_CLI_SIZE_SERVER_H
#define MESHGROW_CLI_SIZE_SERVER_H

#include <cstddef>
#include <functional>

#include "geometry.h"

/// The protocol by which stock Gmsh asks another program for sizes (its field ExternalProcess): a
/// request is three doubles x, y, z in the machine's own byte order, its answer one double; x not a
/// number ends it. Knows no Gmsh.
namespace meshgrow::cli {

/// What Gmsh takes for "no size".
constexpr double served_no_size = 1e22;

/// How a conversation came to its end.
enum class ServeEnd {
  asked,         ///< a request whose x is not a number
  end_of_input,  ///< no more requests
  half_request,  ///< the input ended within a request
  reader_gone    ///< nobody takes answers any more
};

/// As read(2): bytes put into the buffer, at least one, at most `size`; 0 at the end.
using ReadSome = std::function<std::size_t(void* buffer, std::size_t size)>;
/// Writes all; false if nobody takes it any more.
using WriteAll = std::function<bool(const void* data, std::size_t size)>;
/// Sizes at `count` finite points; infinite where there is none.
using SizesAt = std::function<void(const Vec3* points, std::size_t count, double* sizes)>;

/// Answers requests until the end. All whole requests that are there are answered by one call of
/// `sizes` and one of `write`, and nothing is waited for that need not come. Points that are not
/// finite and sizes above `served_no_size`, or not positive, get `served_no_size`. What the three
/// throw is passed on; needs no more memory once it has begun to read.
ServeEnd serve_sizes(const ReadSome& read, const WriteAll& write, const SizesAt& sizes);

/// The same over file descriptors, blocking or not. Throws Error if reading or writing fails for
/// another reason than the end. SIGPIPE must be ignored.
ServeEnd serve_sizes(int input, int output, const SizesAt& sizes);

}  // namespace meshgrow::cli

#endif
