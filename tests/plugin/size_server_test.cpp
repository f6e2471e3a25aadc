#include "size_server.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace meshgrow::cli {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Sizes that tell where they were asked for.
double size_at(const Vec3& p) { return 1.0 + std::abs(p.x() + 10.0 * p.y() + 100.0 * p.z()); }

std::string bytes_of(const std::vector<Vec3>& points) {
  std::string bytes;
  for (const Vec3& p : points) {
    bytes.append(reinterpret_cast<const char*>(p.data()), 3 * sizeof(double));
  }
  return bytes;
}

/// Someone who sends these bytes in pieces and takes the answers.
struct Client {
  std::string bytes;
  std::vector<std::size_t> pieces = {};   ///< lengths; what is left comes at once
  std::size_t takes = std::string::npos;  ///< so many writes
  std::string answered = {};
  std::size_t batches = 0;

  ServeEnd talk() {
    std::size_t sent = 0;
    std::size_t piece = 0;
    return serve_sizes(
        [&](void* buffer, std::size_t room) {
          std::size_t count = piece < pieces.size() ? pieces[piece++] : bytes.size() - sent;
          count = std::min({count, room, bytes.size() - sent});
          std::memcpy(buffer, bytes.data() + sent, count);
          sent += count;
          return count;
        },
        [&](const void* data, std::size_t size) {
          if (batches == takes) {
            return false;
          }
          ++batches;
          answered.append(static_cast<const char*>(data), size);
          return true;
        },
        [](const Vec3* points, std::size_t count, double* sizes) {
          for (std::size_t i = 0; i < count; ++i) {
            EXPECT_TRUE(points[i].allFinite());
            sizes[i] = size_at(points[i]);
          }
        });
  }

  std::vector<double> answers() const {
    std::vector<double> values(answered.size() / sizeof(double));
    std::memcpy(values.data(), answered.data(), values.size() * sizeof(double));
    return values;
  }
};

std::vector<Vec3> some_points(std::size_t count) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(static_cast<double>(i), 0.5, -2.0);
  }
  return points;
}

std::vector<double> sizes_at(const std::vector<Vec3>& points) {
  std::vector<double> sizes;
  for (const Vec3& p : points) {
    sizes.push_back(size_at(p));
  }
  return sizes;
}

TEST(SizeServer, AnswersInTurnUntilItIsToldToEnd) {
  const std::vector<Vec3> points = some_points(5);
  Client client{bytes_of(points) + bytes_of({Vec3::Constant(not_a_number)}) + bytes_of(points)};
  EXPECT_EQ(client.talk(), ServeEnd::asked);
  EXPECT_EQ(client.answers(), sizes_at(points));
  EXPECT_EQ(client.batches, 1u) << "what is there at once is answered at once";
}

TEST(SizeServer, EndOfInputBetweenRequestsIsAnEnd) {
  const std::vector<Vec3> points = some_points(3);
  Client client{bytes_of(points)};
  EXPECT_EQ(client.talk(), ServeEnd::end_of_input);
  EXPECT_EQ(client.answers(), sizes_at(points));
  Client silent{""};
  EXPECT_EQ(silent.talk(), ServeEnd::end_of_input);
}

TEST(SizeServer, HalfARequestIsToldAndWholeOnesAreAnswered) {
  const std::vector<Vec3> points = some_points(3);
  for (std::size_t cut = 1; cut < 24; ++cut) {
    Client client{bytes_of(points).substr(0, 48 + cut)};
    EXPECT_EQ(client.talk(), ServeEnd::half_request);
    EXPECT_EQ(client.answers(), sizes_at(some_points(2)));
  }
}

TEST(SizeServer, AReaderThatIsGoneEndsIt) {
  Client client{bytes_of(some_points(3)), {24, 24, 24}, 1};
  EXPECT_EQ(client.talk(), ServeEnd::reader_gone);
  EXPECT_EQ(client.answers(), sizes_at(some_points(1)));
}

TEST(SizeServer, WhereThereIsNoSizeGmshIsToldSo) {
  const std::vector<Vec3> points = {
      {infinite, 0, 0}, {0, -infinite, 0}, {0, not_a_number, 0}, {1e22, 0, 0}, {1, 2, 3}};
  Client client{bytes_of(points)};
  EXPECT_EQ(client.talk(), ServeEnd::end_of_input);
  const std::vector<double> answers = client.answers();
  ASSERT_EQ(answers.size(), points.size());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(answers[i], 1e22) << i;
  }
  EXPECT_EQ(answers[4], size_at(points[4]));
}

TEST(SizeServer, ItDoesNotMatterInWhichPiecesRequestsCome) {
  constexpr unsigned seed = 5;
  std::mt19937 random(seed);
  const std::vector<Vec3> points = some_points(9000);  // more than are answered at once
  for (int trial = 0; trial < 20; ++trial) {
    Client client{bytes_of(points)};
    const std::size_t longest = trial < 10 ? 100 : 200000;
    for (std::size_t sum = 0; sum < client.bytes.size(); sum += client.pieces.back()) {
      client.pieces.push_back(std::uniform_int_distribution<std::size_t>(1, longest)(random));
    }
    ASSERT_EQ(client.talk(), ServeEnd::end_of_input) << "seed " << seed;
    ASSERT_EQ(client.answers(), sizes_at(points)) << "seed " << seed;
  }
}

TEST(SizeServer, AnyBytesGetOneAnswerForEachRequestOrAnEnd) {
  constexpr unsigned seed = 6;
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes(random() % 200, '\0');
    for (char& byte : bytes) {
      // Bytes of all ones make numbers that are none.
      byte = static_cast<char>(random() % 4 == 0 ? 0xFF : random());
    }
    Client client{bytes, {random() % 50 + 1, random() % 50 + 1}};
    const ServeEnd end = client.talk();
    std::size_t expected = 0;
    bool asked = false;
    for (; !asked && 24 * (expected + 1) <= bytes.size(); expected += asked ? 0 : 1) {
      double x = 0.0;
      std::memcpy(&x, bytes.data() + 24 * expected, sizeof x);
      asked = std::isnan(x);
    }
    ASSERT_EQ(client.answered.size(), 8 * expected) << "seed " << seed << ", trial " << trial;
    ASSERT_EQ(end, asked                    ? ServeEnd::asked
                   : bytes.size() % 24 != 0 ? ServeEnd::half_request
                                            : ServeEnd::end_of_input);
  }
}

TEST(SizeServer, DescriptorsThatDoNotBlockAndAClosedPipe) {
  signal(SIGPIPE, SIG_IGN);
  int in[2];
  int out[2];
  ASSERT_EQ(pipe(in), 0);
  ASSERT_EQ(pipe(out), 0);
  fcntl(in[0], F_SETFL, O_NONBLOCK);
  fcntl(out[1], F_SETFL, O_NONBLOCK);
  const std::string request = bytes_of(some_points(2));
  ASSERT_EQ(write(in[1], request.data(), request.size()), static_cast<ssize_t>(request.size()));
  close(in[1]);
  const SizesAt sizes = [](const Vec3* points, std::size_t count, double* to) {
    std::transform(points, points + count, to, size_at);
  };
  EXPECT_EQ(serve_sizes(in[0], out[1], sizes), ServeEnd::end_of_input);
  double answers[2];
  ASSERT_EQ(read(out[0], answers, sizeof answers), static_cast<ssize_t>(sizeof answers));
  EXPECT_EQ(answers[1], size_at(some_points(2)[1]));
  close(in[0]);

  ASSERT_EQ(pipe(in), 0);
  ASSERT_EQ(write(in[1], request.data(), request.size()), static_cast<ssize_t>(request.size()));
  close(out[0]);
  EXPECT_EQ(serve_sizes(in[0], out[1], sizes), ServeEnd::reader_gone);
  close(in[0]);
  close(in[1]);
  close(out[1]);
}

}  // namespace
}  // namespace meshgrow::cli
