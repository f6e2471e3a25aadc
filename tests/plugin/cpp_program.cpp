// A user's C++ program with the C++ interface, built for each generation of Gmsh.

#ifdef GMSH_OVER_C  // the newest from PyPI: its C++ functions may be of another C++ ABI
#include <gmsh.h_cwrap>
#else
#include <gmsh.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <meshgrow.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

int failures = 0;

void expect(bool condition, const std::string& what) {
  if (!condition) {
    std::printf("FAILED: %s\n", what.c_str());
    ++failures;
  }
}

/// What the body throws, as an Exception; empty if it does not.
template <typename Exception, typename Body>
std::string thrown(Body body) {
  try {
    body();
  } catch (const Exception& exception) {
    return exception.what();
  } catch (...) {
    return "";
  }
  return "";
}

void expect_in(const std::string& part, const std::string& text) {
  expect(text.find(part) != std::string::npos, "\"" + part + "\" in \"" + text + "\"");
}

constexpr int volume = 1;
const meshgrow::DimTags all = {{3, volume}};
const meshgrow::DimTags source = {{2, 1}};

void make_box(const std::string& name) {
  gmsh::model::add(name);
  gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1, volume);
  gmsh::model::occ::synchronize();
}

std::size_t tetrahedra() {
  std::vector<std::size_t> tags;
  std::vector<std::size_t> nodes;
  gmsh::model::mesh::getElementsByType(4, tags, nodes, volume);
  return tags.size();
}

std::size_t tetrahedra_of_a_run() {
  gmsh::model::mesh::clear();
  gmsh::model::mesh::generate(3);
  return tetrahedra();
}

meshgrow::SizeField grown_from_the_source() {
  meshgrow::SizeField field;
  field.add_fixed(source, all, 0.05, 1.3, 0.3);
  return field;
}

void errors_are_thrown() {
  expect_in("initialize", thrown<meshgrow::Error>([] { meshgrow::SizeField field; }));
}

void version_is_that_of_the_header() {
  int major = 0;
  int minor = 0;
  int patch = 0;
  std::sscanf(meshgrow::version().c_str(), "%d.%d.%d", &major, &minor, &patch);
  expect(MESHGROW_VERSION_NUMBER == 10000 * major + 100 * minor + patch, "version number");
}

void all_kinds_can_be_added_and_wrong_ones_throw() {
  make_box("kinds");
  meshgrow::Options options;
  options.evaluator = meshgrow::Evaluator::exact;
  options.calibrate = true;
  meshgrow::SizeField field(options);
  field.add_mesh(source, all, 1.2, 0.5, meshgrow::QuadSize::sides);
  field.add_fixed({{0, 1}}, all, 0.1, 1.2, 0.5);
  field.add_curvature(all, all, 18, 1.2, 0.5, 0.01);
  field.add_proximity(all, all, 2.5, 1.2, 0.5, 0.01, meshgrow::Between::faces);
  field.add("fixed source Curve{1} attach Volume{1} size 0.2 growth 1.2 limit 0.5");
  field.create_defaults(0.5);
  const std::string statistics = field.statistics();
  for (const char* kind : {"\"mesh\"", "\"fixed\"", "\"curvature\"", "\"proximity\""}) {
    expect_in(kind, statistics);
  }
  expect_in("Fixed size function 2", field.summary());
  expect_in("growth", thrown<meshgrow::Error>([&] { field.add_mesh(source, all, 0.5, 1.0); }));
  expect_in("Surface 77", thrown<meshgrow::Error>([&] { field.add_mesh({{2, 77}}, all, 1.2, 1); }));
  options.tolerance = -1.0;
  expect_in("tolerance", thrown<meshgrow::Error>([&] { meshgrow::SizeField bad(options); }));
}

void functions_have_names_and_are_changed_by_them() {
  make_box("names");
  meshgrow::SizeField field;
  const std::string first = field.add_fixed(source, all, 0.05, 1.3, 0.3);
  expect(field.add_fixed(source, all, 0.2, 1.3, 0.3, "coarse") == "coarse", "a given name");
  expect_in("coarse", thrown<meshgrow::Error>(
                          [&] { field.add_fixed(source, all, 0.1, 1.3, 0.3, "coarse"); }));
  expect(field.functions().size() == 2 && field.functions()[1].first == "coarse", "two functions");
  field.rename(first, "fine");
  field.modify("fine", "fixed source Surface{1} attach Volume{1} size 0.1 growth 1.3 limit 0.3");
  const std::vector<double> on_source = {0, 0.5, 0.5};
  expect(std::abs(field.exact_size(3, volume, on_source)[0] - 0.1) < 1e-12, "modified");
  field.remove("fine");
  expect(std::abs(field.exact_size(3, volume, on_source)[0] - 0.2) < 1e-12, "removed");
  expect_in("0.2", field.functions()[0].second);
}

void a_saved_field_answers_the_same() {
  make_box("saved");
  meshgrow::SizeField field = grown_from_the_source();
  const std::string path = "cpp_program_" + std::string(GMSH_API_VERSION) + ".mgf";
  field.save(path);
  const std::vector<double> points = {0.1, 0.5, 0.5, 0.7, 0.2, 0.3};
  const meshgrow::SizeField loaded = meshgrow::SizeField::load(path);
  expect(loaded.size(3, volume, points) == field.size(3, volume, points), "sizes of a file");
  expect(loaded(3, volume, 0.1, 0.5, 0.5) == loaded.size(3, volume, points)[0], "called");
  std::remove(path.c_str());
  expect_in(path, thrown<meshgrow::Error>([&] { meshgrow::SizeField::load(path); }));
}

void sizes_are_answered() {
  make_box("sizes");
  const meshgrow::SizeField field = grown_from_the_source();
  const std::vector<double> exact = field.exact_size(3, volume, {0, 0.5, 0.5, 1, 0.5, 0.5});
  expect(exact.size() == 2 && std::abs(exact[0] - 0.05) < 1e-12, "exact size on the source");
  expect(std::abs(exact[1] - (0.05 + 0.3 / 1.3)) < 1e-9, "exact size opposite");
  const std::vector<double> sizes = field.size(3, volume, {0, 0.5, 0.5, 1, 0.5, 0.5});
  expect(sizes[0] < 0.0526 && sizes[1] <= 1.051 * exact[1], "sizes");
  expect(field(3, volume, 0, 0.5, 0.5) == sizes[0], "size of the callback, as for 4.8");
  expect(field(3, volume, 0, 0.5, 0.5, 0.01) == 0.01, "smaller proposal");
  expect(field(3, 99, 0, 0.5, 0.5) == meshgrow::SizeField::gmsh_no_size, "no size");
  expect(field.smallest_size({0, 0.5, 0.5}) == std::vector<double>{sizes[0]}, "smallest size");
  expect(field.add_view("s", "plane", {3, volume}, {0.5, 0.5, 0.5, 0, 0, 1}, 8) >= 0, "view");
  expect_in("six", thrown<meshgrow::Error>([&] {
              field.add_view("s", "plane", {3, volume}, {0.5, 0.5});
            }));
  expect_in("nonsense", thrown<meshgrow::Error>([&] { field.write_view("sizes.nonsense"); }));
  expect_in("Volume 99",
            thrown<meshgrow::Error>([&] { field.size(3, 99, std::vector<double>(3)); }));
  expect_in("three",
            thrown<meshgrow::Error>([&] { field.size(3, volume, std::vector<double>(4)); }));
}

void a_field_is_a_size_callback() {
  make_box("callback");
  meshgrow::SizeField field = grown_from_the_source();
  field.register_callback();
  const std::size_t registered = tetrahedra_of_a_run();
  field.unregister_callback();
  const std::size_t alone = tetrahedra_of_a_run();
  gmsh::model::mesh::setSizeCallback(std::ref(field));
  const std::size_t called = tetrahedra_of_a_run();
  expect(registered > 3 * alone && called == registered, "as many tetrahedra by std::ref(field)");
  const double small = 0.04;
#ifdef GMSH_OVER_C
  gmsh::model::mesh::setSizeCallback(
      [&](int dim, int tag, double x, double y, double z, double proposed) {
        return std::min(small, field(dim, tag, x, y, z, proposed));
      });
#else
  gmsh::model::mesh::setSizeCallback([&](int dim, int tag, double x, double y, double z) {
    return std::min(small, field(dim, tag, x, y, z));
  });
#endif
  expect(tetrahedra_of_a_run() > 2 * registered, "more tetrahedra by smaller sizes beside it");
  gmsh::model::mesh::removeSizeCallback();
}

void both_signatures_of_gmsh_take_a_field() {
  make_box("signatures");
  meshgrow::SizeField field = grown_from_the_source();
  const std::function<double(int, int, double, double, double)> until_48 = std::ref(field);
  const std::function<double(int, int, double, double, double, double)> since_49 = std::ref(field);
  expect(until_48(3, volume, 0, 0.5, 0.5) == since_49(3, volume, 0, 0.5, 0.5, 1.0), "both");
}

void own_sizes_are_combined_and_may_throw() {
  make_box("combined");
  meshgrow::SizeField field = grown_from_the_source();
  field.generate(3);
  const std::size_t alone = tetrahedra();
  gmsh::model::mesh::clear();
  field.combine([](int, int, double, double, double, double) { return 0.05; });
  field.generate(3);
  expect(tetrahedra() > 2 * alone, "smaller own sizes");
  gmsh::model::mesh::clear();
  field.combine(std::ref(field));  // asks for itself: no harm
  field.generate(3);
  expect(tetrahedra() == alone, "the field's own sizes");
  field.combine([](int, int, double, double, double, double) -> double {
    throw std::domain_error("no size today");
  });
  expect_in("no size today", thrown<std::domain_error>([&] { field.generate(3, true); }));
  field.combine(nullptr);
  gmsh::model::mesh::clear();
  field.generate(3);
  expect(tetrahedra() == alone, "no own sizes");
}

void progress_may_stop_the_work() {
  make_box("progress");
  int lines = 0;
  meshgrow::Options options;
  options.progress = [&lines](const std::string&) {
    if (++lines == 2) {
      throw std::domain_error("enough");
    }
  };
  meshgrow::SizeField field(options);
  field.add_fixed(source, all, 0.05, 1.3, 0.3);
  expect_in("enough", thrown<std::domain_error>([&] { field.generate(3); }));
  expect(lines == 2 && tetrahedra() == 0, "stopped");
}

void a_field_may_be_moved() {
  make_box("moved");
  meshgrow::SizeField first = grown_from_the_source();
  int calls = 0;
  first.combine([&calls](int, int, double, double, double, double so_far) {
    ++calls;
    return so_far;
  });
  meshgrow::SizeField second = std::move(first);
  second.generate(2);
  expect(calls > 100, "own sizes move along");
}

void reports_are_read() {
  make_box("report");
  meshgrow::SizeField field = grown_from_the_source();
  expect_in("Pass 3", field.plan(3) + field.plan_json(3));
  field.generate(3);
  const meshgrow::Report report = meshgrow::report(3, all, field);
  expect(report.value("elements") == static_cast<double>(tetrahedra()), "elements");
  expect(report.value("ratio_99") > 1.0 && report.value("length_median") < 2.0, "numbers");
  expect(std::isnan(meshgrow::report(3).value("length_median")), "nothing to compare with");
  expect_in("nonsense", thrown<meshgrow::Error>([&] { report.value("nonsense"); }));
  const std::string name = "a \"box\" \\ of\nmine";
  expect_in("a \"box\" \\ of mine", meshgrow::report_table({{name, report}, {"b", report}}));
}

int run() {
  errors_are_thrown();
  version_is_that_of_the_header();
  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0);
  all_kinds_can_be_added_and_wrong_ones_throw();
  functions_have_names_and_are_changed_by_them();
  a_saved_field_answers_the_same();
  sizes_are_answered();
  a_field_is_a_size_callback();
  both_signatures_of_gmsh_take_a_field();
  own_sizes_are_combined_and_may_throw();
  progress_may_stop_the_work();
  a_field_may_be_moved();
  reports_are_read();
  gmsh::finalize();
  if (failures == 0) {
    std::printf("C++ program: all good with meshgrow %s\n", meshgrow::version().c_str());
  }
  return failures;
}

}  // namespace

int main() {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "C++ program: %s\n", error.what());
    return 1;
  }
}
