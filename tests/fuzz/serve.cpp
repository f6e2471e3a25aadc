// The protocol of `meshgrow serve`: any bytes in any pieces get one answer for each request, the
// size that the field has there.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "fuzz_target.h"
#include "size_field.h"
#include "size_server.h"
#include "sphere_field.h"

namespace meshgrow::fuzz {
namespace {

const SizeField& field() {
  static const SizeField made = test::sphere_field(12, Evaluator::exact);
  return made;
}

void sizes_at(const Vec3* points, std::size_t count, double* sizes) {
  for (std::size_t i = 0; i < count; ++i) {
    require(points[i].allFinite(), "sizes are asked for at finite points only");
  }
  field().smallest_sizes(points, count, sizes);
}

/// The other side of the conversation.
struct Client {
  const char* next;
  std::size_t left;
  const std::uint8_t* pieces;  ///< lengths of what comes at once, over and over
  std::size_t piece_count;
  std::size_t reads = 0;
  std::size_t most_answers;  ///< taken before it goes away
  std::vector<double> answers = {};

  std::size_t read(void* buffer, std::size_t size) {
    const std::size_t piece = piece_count == 0 ? size : 1 + pieces[reads++ % piece_count];
    const std::size_t count = std::min({piece, size, left});
    std::memcpy(buffer, next, count);
    next += count;
    left -= count;
    return count;
  }

  bool write(const void* data, std::size_t size) {
    require(size > 0 && size % sizeof(double) == 0, "answers are whole numbers of doubles");
    const std::size_t before = answers.size();
    answers.resize(before + size / sizeof(double));
    std::memcpy(answers.data() + before, data, size);
    return answers.size() <= most_answers;
  }
};

/// One byte tells how many lengths of pieces follow, one after how many answers nobody reads any
/// more (255: never); all else is what the server reads.
void check(const std::uint8_t* data, std::size_t size) {
  if (size < 2) {
    return;
  }
  const std::size_t piece_count = std::min<std::size_t>(data[0] % 8, size - 2);
  const std::uint8_t* pieces = data + 2;
  const char* bytes = reinterpret_cast<const char*>(pieces + piece_count);
  const std::size_t count = size - 2 - piece_count;
  const std::size_t most = data[1] == 255 ? count : data[1];
  Client client{bytes, count, pieces, piece_count, 0, most};
  const cli::ServeEnd end = cli::serve_sizes(
      [&](void* to, std::size_t room) { return client.read(to, room); },
      [&](const void* from, std::size_t n) { return client.write(from, n); }, sizes_at);
  const std::vector<double>& answers = client.answers;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    require(24 * (i + 1) <= count, "there are no more answers than requests");
    Vec3 p;
    std::memcpy(p.data(), bytes + 24 * i, sizeof(p));
    require(!std::isnan(p.x()), "nothing is answered from the end on");
    double expected = cli::served_no_size;
    if (p.allFinite()) {
      field().smallest_sizes(&p, 1, &expected);
    }
    require(answers[i] == expected, "an answer is the size that the field has there");
  }
  if (end == cli::ServeEnd::end_of_input || end == cli::ServeEnd::half_request) {
    require(answers.size() == count / 24, "all requests are answered");
    require((end == cli::ServeEnd::half_request) == (count % 24 != 0), "the end is told as it is");
  }
}

}  // namespace
}  // namespace meshgrow::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  meshgrow::fuzz::check(data, size);
  return 0;
}
