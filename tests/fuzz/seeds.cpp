// Writes inputs for fuzz targets to begin with: seeds FOLDER makes FOLDER/TARGET/NAME.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "ball_and_cube.h"
#include "field_file.h"
#include "graded_sphere.h"
#include "size_field.h"

namespace meshgrow::fuzz {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

void write_texts(const fs::path& folder) {
  const std::vector<std::string> texts = {
      "mesh source Surface{7} attach Volume{2} growth 1.2 limit 2 quad_size sides",
      "fixed source Curve{1,4:6} attach Physical Surface{\"in\"} size 0.1 limit 2 name \"a b\"",
      "curvature source Surface{:} attach Volume{1} angle 18 growth 1.2 limit 2 min 0.01",
      "proximity source Volume{1} attach Volume{:} cells 3 between both growth 1.2 limit 2 name a",
      "fixed source Line{1} attach Physical Surface{outer wall, 3} size 1e-3 growth +1.5 limit 9",
      "Volume{2}, Physical Surface{\"inlet\"}, Physical Volume{1}"};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    write(folder / std::to_string(i + 1), texts[i]);
  }
}

/// Two volumes beside each other; functions of two kinds, one of them acts inside its source.
SizeField two_volumes(std::size_t triangles, double tolerance, Evaluator evaluator) {
  Topology topology = test::ball_and_cube();
  topology.add_physical_group({2, 5, "wall", {{2, 1}}});
  FieldOptions options;
  options.tolerance = tolerance;
  options.evaluator = evaluator;
  options.threads = 1;
  SizeField field(topology, options);
  SizeFunction function;
  function.sources = {{2, 1}};
  function.attachments = {{3, 1}};
  function.size_limit = 1.0;
  field.add(function);
  function.kind = Kind::fixed;
  function.name = "inside";
  function.start_size = 0.1;
  function.sources = {{3, 2}, {2, 2}};
  function.attachments = {{3, 2}, {2, 1}};
  field.add(function);
  FacetedSource sphere;
  sphere.entity = {2, 1};
  sphere.triangles = test::graded_sphere(triangles, 6.0);
  field.set_sources(0, {sphere});
  FacetedSource few;
  few.entity = {2, 2};
  few.points = {Vec3(3, 0, 0)};
  few.segments = {{Vec3(3, 0, 0), Vec3(4, 0, 0)}};
  few.quads = {{Vec3(3, 0, 0), Vec3(4, 0, 0), Vec3(4, 1, 0), Vec3(3, 1, 0)}};
  field.set_sources(1, {few});
  field.build_grids();
  return field;
}

void write_fields(const fs::path& folder) {
  fs::create_directories(folder);
  save_field(two_volumes(30, 0.5, Evaluator::exact), (folder / "trees.mgf").string());
  save_field(two_volumes(20, 1.0, Evaluator::grid), (folder / "small.mgf").string());
  save_field(two_volumes(90, 1.0, Evaluator::exact), (folder / "deep_tree.mgf").string());
}

/// As input_numbers.h reads them.
class Numbers {
 public:
  Numbers& byte(unsigned value) {
    bytes_ += static_cast<char>(value);
    return *this;
  }
  Numbers& number(double value) {
    byte(255);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return *this;
  }
  Numbers& point(const Vec3& p) { return number(p.x()).number(p.y()).number(p.z()); }
  /// On the lattice of input_numbers.h.
  Numbers& coarse(const Vec3& p) {
    for (const double x : {p.x(), p.y(), p.z()}) {
      byte(static_cast<unsigned>(16.0 * x + 112.0));
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

void write_facets(const fs::path& folder) {
  const Vec3 a(0, 0, 0);
  const Vec3 b(1, 0, 0);
  const Vec3 c(1, 1, 0);
  const Vec3 d(0, 1, 0);
  const Vec3 up(0, 0, 0.5);
  for (unsigned kind = 0; kind < 4; ++kind) {
    for (const bool is_plain : {true, false}) {
      Numbers input;
      input.byte(kind | (is_plain ? 0 : 4)).number(1.2).number(2.0).number(is_plain ? 0.01 : 1.0);
      input.byte(64 | 4 | (is_plain ? 0 : 2)).coarse(a - up).coarse(c + 2 * up).coarse(0.3 * c);
      const Vec3 bend = is_plain ? Vec3::Zero() : up;
      input.byte(3).coarse(a).coarse(b).coarse(c).coarse(d);
      input.byte(128 + 2).coarse(a + up).coarse(b + up + bend).coarse(c + up);
      input.byte(128 + 2).coarse(a + up).coarse(c + up).coarse(d + up);
      input.byte(1).coarse(b).coarse(c + bend).byte(0).coarse(0.5 * up);
      write(folder / (std::to_string(kind) + (is_plain ? "a" : "b")), input.bytes());
    }
  }
  Numbers many;
  many.byte(1).number(1.3).number(1.0).number(0.2).byte(4 | 3).coarse(-b - d - up).coarse(c + up);
  for (const auto& triangle : test::graded_sphere(30, 3.0)) {
    many.byte(2).point(triangle[0]).point(triangle[1]).point(triangle[2]);
  }
  write(folder / "sphere", many.bytes());
}

void write_requests(const fs::path& folder) {
  std::string points;
  for (int i = 0; i < 40; ++i) {
    const double p[3] = {0.1 * i - 2.0, 0.7, i % 5 == 0 ? INFINITY : -0.05 * i};
    points.append(reinterpret_cast<const char*>(p), sizeof(p));
  }
  const std::string end(24, '\xff');
  write(folder / "at_once", std::string("\0\xff", 2) + points + end);
  write(folder / "in_pieces", std::string("\x3\xff\x05\xff\x17", 5) + points + end);
  write(folder / "half_request", std::string("\1\xff\x2f", 3) + points + "cut off");
  write(folder / "reader_gone", std::string("\1\x5\x2f", 3) + points);
}

}  // namespace
}  // namespace meshgrow::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    return 1;
  }
  const std::filesystem::path folder = argv[1];
  meshgrow::fuzz::write_texts(folder / "text");
  meshgrow::fuzz::write_fields(folder / "field_file");
  meshgrow::fuzz::write_facets(folder / "facets");
  meshgrow::fuzz::write_requests(folder / "serve");
  return 0;
}
