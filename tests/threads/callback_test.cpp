// Gmsh's size callback and the other questions that several threads may ask a field at once, with
// the Gmsh that MESHGROW_GMSH_LIB names.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "at_once.h"
#include "gmsh_api.h"
#include "meshgrow.h"
#include "random_facets.h"
#include "temporary_directory.h"

namespace meshgrow {
namespace {

using Field = std::unique_ptr<meshgrow_field, decltype(&meshgrow_field_destroy)>;

constexpr int volume = 1;
constexpr std::size_t point_count = 300;

/// Of a file as Gmsh opens it. 4.8 passes over some statements that stand in one line.
void open_model(const std::string& text) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "model.geo").string();
  std::ofstream(path) << text << '\n';
  gmsh::open(path);
}

/// A unit cube whose face at z = 0 is surface 1.
const char* const cube = R"(
Point(1) = {0, 0, 0, 0.3};
Point(2) = {1, 0, 0, 0.3};
Point(3) = {1, 1, 0, 0.3};
Point(4) = {0, 1, 0, 0.3};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Extrude {0, 0, 1} { Surface{1}; }
)";

class Callback : public testing::Test {
 public:
  /// What a field may be asked with from several threads.
  enum class Question { size, exact, smallest, callback, callback_4_8 };

 protected:
  void SetUp() override {
    gmsh::initialize({"test", "-v", "2"});
    open_model(cube);
    gmsh::set_option("General.NumThreads", test::thread_count);
    test::Random random(3);
    for (std::size_t i = 0; i < 3 * point_count; ++i) {
      points_.push_back(test::uniform(random, 0.0, 1.0));
    }
  }
  void TearDown() override { gmsh::finalize(); }

  static Field field_of(const std::string& function, double evaluator = 1.0) {
    Field field(meshgrow_field_create(), meshgrow_field_destroy);
    EXPECT_NE(field, nullptr) << meshgrow_last_error();
    EXPECT_EQ(meshgrow_field_set_option(field.get(), "evaluator", evaluator), 0);
    EXPECT_EQ(meshgrow_field_set_option(field.get(), "tolerance", 0.2), 0);
    EXPECT_EQ(meshgrow_field_add(field.get(), function.c_str()), 0) << meshgrow_last_error();
    return field;
  }
  static Field fixed_field() {
    return field_of("fixed source Surface{1} attach Volume{1} size 0.05 growth 1.3 limit 0.3");
  }
  static Field mesh_field() {
    return field_of("mesh source Surface{1} attach Volume{1} growth 1.3 limit 1");
  }

  std::vector<double> ask(meshgrow_field* field, Question question) const {
    std::vector<double> sizes(point_count, -1.0);
    switch (question) {
      case Question::size:
        meshgrow_field_size(field, 3, volume, points_.data(), point_count, sizes.data());
        break;
      case Question::exact:
        meshgrow_field_exact_size(field, 3, volume, points_.data(), point_count, sizes.data());
        break;
      case Question::smallest:
        meshgrow_field_smallest_size(field, points_.data(), point_count, sizes.data());
        break;
      default:
        for (std::size_t i = 0; i < point_count; ++i) {
          const double* p = &points_[3 * i];
          sizes[i] = question == Question::callback
                         ? meshgrow_field_callback(3, volume, p[0], p[1], p[2], 1e22, field)
                         : meshgrow_field_callback_4_8(3, volume, p[0], p[1], p[2], field);
        }
    }
    return sizes;
  }

  /// Thread i asks questions[i], all at once; then each must have had the answers that it gets now.
  void expect_same_answers(meshgrow_field* field,
                           const std::array<Question, test::thread_count>& questions) const {
    std::array<std::vector<double>, test::thread_count> answers;
    test::at_once([&](int thread) {
      const auto i = static_cast<std::size_t>(thread);
      answers[i] = ask(field, questions[i]);
    });
    for (std::size_t i = 0; i < answers.size(); ++i) {
      EXPECT_EQ(answers[i], ask(field, questions[i])) << "thread " << i;
      EXPECT_GE(*std::min_element(answers[i].begin(), answers[i].end()), 0.04) << "thread " << i;
      EXPECT_LE(*std::max_element(answers[i].begin(), answers[i].end()), 1.0) << "thread " << i;
    }
  }

  static std::size_t tetrahedra() {
    std::size_t count = 0;
    for (const gmsh::Elements& some : gmsh::elements({3, volume})) {
      count += some.tags.size();
    }
    return count;
  }

  std::vector<double> points_;  ///< three coordinates each
};

using Question = Callback::Question;
constexpr std::array<Question, test::thread_count> sizes_only = {
    Question::size, Question::exact, Question::smallest, Question::size};
constexpr std::array<Question, test::thread_count> calls_only = {
    Question::callback, Question::callback_4_8, Question::callback, Question::callback};
constexpr std::array<Question, test::thread_count> all_sorts = {
    Question::callback, Question::size, Question::callback_4_8, Question::exact};

// ==== First questions, which bring the field up to date

TEST_F(Callback, FirstQuestionsMayComeAtOnce) {
  for (const auto& questions : {sizes_only, calls_only, all_sorts}) {
    expect_same_answers(fixed_field().get(), questions);
  }
}

TEST_F(Callback, FirstQuestionsOfASourceThatIsMeshedMayComeAtOnce) {
  gmsh::generate(2);
  for (const auto& questions : {sizes_only, calls_only, all_sorts}) {
    expect_same_answers(mesh_field().get(), questions);
  }
}

TEST_F(Callback, FirstQuestionsOfASavedFieldMayComeAtOnce) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "field.mgf").string();
  ASSERT_EQ(meshgrow_field_save(fixed_field().get(), path.c_str()), 0) << meshgrow_last_error();
  for (const auto& questions : {sizes_only, calls_only, all_sorts}) {
    const Field loaded(meshgrow_field_load(path.c_str()), meshgrow_field_destroy);
    expect_same_answers(loaded.get(), questions);
  }
}

// ==== Changes

TEST_F(Callback, ASourceMeshedAnewIsReadOnceForAll) {
  gmsh::generate(2);
  const Field field = mesh_field();
  const std::vector<double> before = ask(field.get(), Question::size);
  gmsh::set_option("Mesh.MeshSizeMax", 0.12);
  gmsh::generate(2);
  expect_same_answers(field.get(), sizes_only);
  EXPECT_LT(ask(field.get(), Question::size), before);
}

TEST_F(Callback, MayBeCalledDuringARefresh) {
  const Field field = fixed_field();
  const std::vector<double> expected = ask(field.get(), Question::callback);
  test::at_once([&](int thread) {
    for (int round = 0; round < 5; ++round) {
      if (thread == 0) {
        EXPECT_EQ(meshgrow_field_refresh(field.get()), 0);
      } else {
        EXPECT_EQ(ask(field.get(), Question::callback), expected);
      }
    }
  });
}

TEST_F(Callback, FieldsMayComeAndGoBetweenCalls) {
  for (int round = 0; round < 5; ++round) {
    const Field field = fixed_field();
    expect_same_answers(field.get(), calls_only);
    ASSERT_EQ(meshgrow_field_register(field.get()), 0) << meshgrow_last_error();
    const Field other = fixed_field();
    ASSERT_EQ(meshgrow_field_register(other.get()), 0) << meshgrow_last_error();
    expect_same_answers(field.get(), calls_only);
    expect_same_answers(other.get(), all_sorts);
    ASSERT_EQ(meshgrow_field_unregister(field.get()), 0) << meshgrow_last_error();
    expect_same_answers(field.get(), all_sorts);
  }
}

// ==== Who would wait for itself

/// What a call told that came from within the field's own work.
struct Told {
  meshgrow_field* field;
  int result = -1;
  std::string error = {};

  void keep(int told) {
    result = told;
    error = meshgrow_last_error();
  }
};

TEST_F(Callback, OwnSizesThatRefreshGetAnError) {
  const Field field = fixed_field();
  Told told{field.get()};
  const auto refreshing = [](int, int, double, double, double, double so_far, void* data) {
    auto* own = static_cast<Told*>(data);
    own->keep(meshgrow_field_refresh(own->field));
    return so_far;
  };
  ASSERT_EQ(meshgrow_field_combine(field.get(), refreshing, &told), 0);
  ask(field.get(), Question::callback);
  EXPECT_EQ(told.result, 1);
  EXPECT_NE(told.error.find("your own sizes"), std::string::npos) << told.error;
}

TEST_F(Callback, AListenerThatAsksDuringARefreshGetsAnError) {
  const Field field = fixed_field();
  Told told{field.get()};
  const auto asking = [](const char*, void* data) {
    auto* own = static_cast<Told*>(data);
    const std::array<double, 3> p = {0.5, 0.5, 0.5};
    double size = 0.0;
    own->keep(meshgrow_field_size(own->field, 3, volume, p.data(), 1, &size));
    return 0;
  };
  ASSERT_EQ(meshgrow_field_set_progress(field.get(), asking, &told), 0);
  EXPECT_EQ(meshgrow_field_refresh(field.get()), 0) << meshgrow_last_error();
  EXPECT_EQ(told.result, 1);
  EXPECT_NE(told.error.find("listener"), std::string::npos) << told.error;
}

// ==== Gmsh's own threads

/// Own sizes that ask the field as well, from the threads of Gmsh.
double own_sizes(int dim, int tag, double x, double y, double z, double so_far, void* field) {
  const std::array<double, 3> p = {x, y, z};
  double size = 0.0;
  auto* asked = static_cast<meshgrow_field*>(field);
  if (meshgrow_field_size(asked, dim, tag, p.data(), 1, &size) != 0) {
    return 1e-3;  // seen by the number of elements
  }
  return std::min(size, meshgrow_field_callback(dim, tag, x, y, z, so_far, asked));
}

class CallbackFromGmsh : public Callback, public testing::WithParamInterface<int> {
 protected:
  void SetUp() override {
    Callback::SetUp();
    gmsh::set_option("Mesh.Algorithm3D", GetParam());
    gmsh::set_option("Mesh.MeshSizeMax", 0.2);
    if (gmsh::is_4_8()) {  // whose HXT leaves holes on several threads
      gmsh::set_option("Mesh.MaxNumThreads3D", 1);
    }
  }
};

TEST_P(CallbackFromGmsh, OfARegisteredFieldWhoseSourceTheRunMeshes) {
  const Field field = mesh_field();
  ASSERT_EQ(meshgrow_field_combine(field.get(), own_sizes, field.get()), 0);
  ASSERT_EQ(meshgrow_field_register(field.get()), 0) << meshgrow_last_error();
  gmsh::generate(3);
  EXPECT_GT(tetrahedra(), 200U);
  EXPECT_LT(tetrahedra(), 20000U);
}

TEST_P(CallbackFromGmsh, InThePassesOfAField) {
  const Field field = fixed_field();
  ASSERT_EQ(meshgrow_field_combine(field.get(), own_sizes, field.get()), 0);
  ASSERT_EQ(meshgrow_field_generate(field.get(), 3, 0), 0) << meshgrow_last_error();
  EXPECT_GT(tetrahedra(), 2000U);
  EXPECT_LT(tetrahedra(), 200000U);
}

INSTANTIATE_TEST_SUITE_P(With, CallbackFromGmsh, testing::Values(1, 10),
                         [](const testing::TestParamInfo<int>& param_info) {
                           return std::string(param_info.param == 1 ? "Delaunay" : "HXT");
                         });

}  // namespace
}  // namespace meshgrow
