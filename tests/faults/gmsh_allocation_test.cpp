// Memory that runs out at each step of what is done with a Gmsh model, through the C interface.
// That of Gmsh itself does not: what it does then is not ours.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "c_results.h"
#include "failing_steps.h"
#include "gmsh_api.h"
#include "meshgrow.h"
#include "test_with_folder.h"

namespace meshgrow {
namespace {

namespace fs = std::filesystem;
using cli::FieldPointer;
using test::fail_at_each_step;

constexpr const char* two_boxes = R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeMax = 0.7;
)";
constexpr const char* mesh_function =
    "mesh source Surface{2} attach Volume{2} growth 1.2 limit 1 name wall";
constexpr const char* changed_function =
    "mesh source Surface{2} attach Volume{1,2} growth 1.5 limit 0.9 name wall";

/// Throws Error unless the call was done; memory must be the reason.
void done(int failed) {
  if (failed != 0) {
    const std::string sentence = meshgrow_last_error();
    EXPECT_EQ(sentence.rfind("Out of memory: ", 0), 0u) << sentence;
    throw Error(sentence);
  }
}

FieldPointer made_field() {
  FieldPointer field(meshgrow_field_create());
  done(field ? 0 : 1);
  done(meshgrow_field_set_option(field.get(), "evaluator", 1.0));
  done(meshgrow_field_set_option(field.get(), "tolerance", 0.5));
  done(meshgrow_field_add(field.get(), mesh_function));
  done(meshgrow_field_add(field.get(),
                          "fixed source Curve{1} attach Volume{1} size 0.2 growth 1.3 limit 1"));
  done(meshgrow_field_add(
      field.get(), "curvature source Volume{2} attach Volume{2} angle 18 growth 1.2 limit 1"));
  done(meshgrow_field_add(
      field.get(), "proximity source Volume{1} attach Volume{1} cells 2 growth 1.2 limit 1"));
  return field;
}

/// As Gmsh is told, without reading anything.
std::vector<double> answers_of(meshgrow_field* field) {
  std::vector<double> answers;
  for (int i = 0; i < 200; ++i) {
    const int volume = 1 + i % 2;
    answers.push_back(meshgrow_field_answer(field, 3, volume, 1.0 + std::sin(1.1 * i),
                                            std::fabs(std::sin(1.7 * i)),
                                            std::fabs(std::sin(2.3 * i)), 1e22));
  }
  return answers;
}

/// Two boxes whose surfaces are meshed.
class OutOfMemoryInGmsh : public test::TestWithFolder {
 protected:
  OutOfMemoryInGmsh() {
    std::ofstream(folder_ / "model.geo") << two_boxes;
    gmsh::initialize({"test", "-v", "0", "-nt", "1"});
    gmsh::open((folder_ / "model.geo").string());
    gmsh::generate(2);
  }
  ~OutOfMemoryInGmsh() override { gmsh::finalize(); }

  /// What is Gmsh's, and must be as before.
  static std::vector<double> state() {
    std::vector<double> result;
    for (const char* option : {"Mesh.MeshOnlyVisible", "Mesh.MeshOnlyEmpty", "Mesh.Renumber",
                               "Mesh.MeshSizeExtendFromBoundary", "General.AbortOnError",
                               "General.Verbosity", "Mesh.ElementOrder"}) {
      result.push_back(gmsh::option(option));
    }
    for (const Entity& entity : gmsh::entities()) {
      result.push_back(gmsh::visible(entity) ? 1.0 : 0.0);
    }
    const gmsh::Nodes nodes = gmsh::nodes({2, 2});
    result.insert(result.end(), nodes.coordinates.begin(), nodes.coordinates.end());
    return result;
  }
};

TEST_F(OutOfMemoryInGmsh, AFieldIsMadeOrNot) {
  fail_at_each_step(
      80, [] { return 0; },
      [](int) {
        const FieldPointer field = made_field();
        done(meshgrow_field_refresh(field.get()));
      },
      [before = state()](int) { EXPECT_EQ(state(), before); }, true);
}

TEST_F(OutOfMemoryInGmsh, ARegisteredFieldThatIsChangedAnswersAsBefore) {
  std::vector<double> before;
  fail_at_each_step(
      80,
      [&before] {
        FieldPointer field = made_field();
        done(meshgrow_field_register(field.get()));
        before = answers_of(field.get());
        return field;
      },
      [](const FieldPointer& field) {
        done(meshgrow_field_modify(field.get(), "wall", changed_function));
      },
      [&before](const FieldPointer& field) {
        EXPECT_EQ(answers_of(field.get()), before);
        EXPECT_EQ(cli::take_text(meshgrow_field_function_text(field.get(), 0)).find("1.5"),
                  std::string::npos);
        done(meshgrow_field_modify(field.get(), "wall", changed_function));
        EXPECT_NE(answers_of(field.get()), before);
      },
      true);
}

TEST_F(OutOfMemoryInGmsh, RegisteringChangesNothingUntilItIsDone) {
  fail_at_each_step(
      60, [] { return made_field(); },
      [](const FieldPointer& field) { done(meshgrow_field_register(field.get())); },
      [before = state()](const FieldPointer& field) {
        EXPECT_EQ(state(), before);
        done(meshgrow_field_register(field.get()));
        done(meshgrow_field_unregister(field.get()));
      },
      true);
}

TEST_F(OutOfMemoryInGmsh, GmshIsAsBeforeWhenMeshingFails) {
  fail_at_each_step(
      40, [] { return made_field(); },
      [](const FieldPointer& field) {
        done(meshgrow_field_generate(field.get(), 3, 0));
        gmsh::clear_mesh({{3, 1}, {3, 2}});
      },
      [before = state()](const FieldPointer& field) {
        EXPECT_EQ(state(), before);
        done(meshgrow_field_generate(field.get(), 3, 0));
        gmsh::clear_mesh({{3, 1}, {3, 2}});
      },
      true);
}

TEST_F(OutOfMemoryInGmsh, AnswersAreSizesOrWhatGmshProposes) {
  const FieldPointer field = made_field();
  done(meshgrow_field_register(field.get()));
  const double size = meshgrow_field_answer(field.get(), 3, 2, 1.5, 0.5, 0.5, 1e22);
  for (std::size_t step = 1; step <= 20; ++step) {
    const test::FailingAllocations failing(step);
    const double answer = meshgrow_field_callback(3, 2, 1.5, 0.5, 0.5, 1e22, field.get());
    EXPECT_TRUE(answer == size || answer == 1e22) << answer;
  }
}

TEST_F(OutOfMemoryInGmsh, TextsAndFilesAreWholeOrNotThere) {
  const FieldPointer field = made_field();
  done(meshgrow_field_refresh(field.get()));
  const std::string view = (folder_ / "view.pos").string();
  // Not those in JSON: nlohmann's destructor needs memory, and ends the process without any.
  const auto text_of = [&](int which) {
    return which == 0 ? meshgrow_field_summary(field.get()) : meshgrow_field_plan(field.get(), 3);
  };
  for (int which = 0; which < 2; ++which) {
    SCOPED_TRACE(which);
    const std::string whole = cli::take_text(text_of(which));
    fail_at_each_step(
        30, [] { return 0; },
        [&](int) {
          char* text = text_of(which);
          done(text == nullptr ? 1 : 0);
          EXPECT_EQ(std::string(text), whole);
          meshgrow_free(text);
        },
        [](int) {}, true);
  }
  fail_at_each_step(
      60,
      [&] {
        std::ofstream(view) << "of before";
        return 0;
      },
      [&](int) {
        if (meshgrow_field_write_view(field.get(), view.c_str(), -1, 0, nullptr) != 0) {
          throw Error(meshgrow_last_error());
        }
      },
      [&](int) {
        EXPECT_EQ(fs::file_size(view), 9u);
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
      },
      true);
}

}  // namespace
}  // namespace meshgrow
