#include "size_server.h"

#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "error.h"

namespace meshgrow::cli {

namespace {

constexpr std::size_t request_bytes = 3 * sizeof(double);
constexpr std::size_t most_requests = 4096;

/// Of an event that a descriptor which does not block waits for.
void wait_for(int descriptor, short event) {
  pollfd wanted = {descriptor, event, 0};
  ::poll(&wanted, 1, -1);
}

bool is_transient(int descriptor, short event) {
  if (errno == EAGAIN || errno == EWOULDBLOCK) {
    wait_for(descriptor, event);
    return true;
  }
  return errno == EINTR;
}

/// To be woken takes a process some 40 µs where nothing else runs, and the next request comes
/// sooner: looks for it for so long before it sleeps. Others may run meanwhile.
void look_for_input(int input) {
  constexpr std::chrono::microseconds most(100);
  const auto start = std::chrono::steady_clock::now();
  pollfd wanted = {input, POLLIN, 0};
  while (::poll(&wanted, 1, 0) == 0 && std::chrono::steady_clock::now() - start < most) {
    ::sched_yield();
  }
}

std::size_t read_some(int input, void* buffer, std::size_t size) {
  look_for_input(input);
  while (true) {
    const ssize_t count = ::read(input, buffer, size);
    if (count >= 0) {
      return static_cast<std::size_t>(count);
    }
    if (!is_transient(input, POLLIN)) {
      throw Error(std::string("Cannot read requests (") + std::strerror(errno) +
                  "): give them on standard input, as Gmsh does.");
    }
  }
}

bool write_all(int output, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t count = ::write(output, next, size);
    if (count >= 0) {
      next += count;
      size -= static_cast<std::size_t>(count);
    } else if (errno == EPIPE) {
      return false;
    } else if (!is_transient(output, POLLOUT)) {
      throw Error(std::string("Cannot write answers (") + std::strerror(errno) +
                  "): take them from standard output, as Gmsh does.");
    }
  }
  return true;
}

/// Answers the requests in the bytes; the last one may be cut off. Takes all its memory at once:
/// Gmsh would wait for ever for an answer that there is no memory for.
class Batch {
 public:
  Batch() {
    answers_.reserve(most_requests);
    points_.reserve(most_requests);
    places_.reserve(most_requests);
    found_.reserve(most_requests);
  }

  /// Returns whether one of the requests asks to end: those before it are answered.
  bool answer(const char* bytes, std::size_t requests, const SizesAt& sizes) {
    answers_.clear();
    points_.clear();
    places_.clear();
    bool ends = false;
    for (std::size_t i = 0; i < requests && !ends; ++i) {
      Vec3 p;
      std::memcpy(p.data(), bytes + i * request_bytes, request_bytes);
      ends = std::isnan(p.x());
      if (!ends) {
        if (p.allFinite()) {
          points_.push_back(p);
          places_.push_back(i);
        }
        answers_.push_back(served_no_size);
      }
    }
    if (!points_.empty()) {
      found_.resize(points_.size());
      sizes(points_.data(), points_.size(), found_.data());
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (found_[i] > 0.0 && found_[i] < served_no_size) {
          answers_[places_[i]] = found_[i];
        }
      }
    }
    return ends;
  }

  const std::vector<double>& answers() const { return answers_; }

 private:
  std::vector<double> answers_;
  std::vector<Vec3> points_;         ///< those that are finite
  std::vector<std::size_t> places_;  ///< among the answers
  std::vector<double> found_;
};

}  // namespace

ServeEnd serve_sizes(const ReadSome& read, const WriteAll& write, const SizesAt& sizes) {
  std::vector<char> buffer(most_requests * request_bytes);
  std::size_t filled = 0;
  Batch batch;
  while (true) {
    const std::size_t count = read(buffer.data() + filled, buffer.size() - filled);
    if (count == 0) {
      return filled > 0 ? ServeEnd::half_request : ServeEnd::end_of_input;
    }
    filled += count;
    const std::size_t requests = filled / request_bytes;
    const bool ends = batch.answer(buffer.data(), requests, sizes);
    const std::vector<double>& answers = batch.answers();
    if (!answers.empty() && !write(answers.data(), answers.size() * sizeof(double))) {
      return ServeEnd::reader_gone;
    }
    if (ends) {
      return ServeEnd::asked;
    }
    filled -= requests * request_bytes;
    std::memmove(buffer.data(), buffer.data() + requests * request_bytes, filled);
  }
}

ServeEnd serve_sizes(int input, int output, const SizesAt& sizes) {
  return serve_sizes(
      [input](void* buffer, std::size_t size) { return read_some(input, buffer, size); },
      [output](const void* data, std::size_t size) { return write_all(output, data, size); },
      sizes);
}

}  // namespace meshgrow::cli
