// The one-line text of size functions: whatever is read is a function or an Error, and what was
// read is written so that it reads the same again.

#include <string>

#include "error.h"
#include "fuzz_target.h"
#include "size_field.h"
#include "size_function_text.h"

namespace meshgrow::fuzz {
namespace {

Topology make_model() {
  Topology model;
  for (int tag = 1; tag <= 4; ++tag) {
    model.add_entity({0, tag}, {}, Box(Vec3::Zero(), Vec3::Zero()));
  }
  for (int tag = 1; tag <= 6; ++tag) {
    model.add_entity({1, tag}, {{0, 1 + tag % 4}}, Box(Vec3::Zero(), Vec3::Ones()));
  }
  for (const int tag : {1, 2, 7, 2147483647}) {
    model.add_entity({2, tag}, {{1, 1}, {1, 2}}, Box(Vec3::Zero(), Vec3::Ones()));
  }
  model.add_entity({3, 1}, {{2, 1}, {2, 2}}, Box(Vec3::Zero(), Vec3::Ones()));
  model.add_entity({3, 2}, {{2, 7}, {0, 4}}, Box(Vec3::Zero(), Vec3::Ones()));
  model.add_physical_group({2, 3, "inlet", {{2, 1}, {2, 7}}});
  model.add_physical_group({2, 4, "outer wall", {{2, 2}}});
  model.add_physical_group({3, 1, "", {{3, 1}}});
  return model;
}

const Topology model = make_model();

bool is_same(const SizeFunction& a, const SizeFunction& b) {
  return a.kind == b.kind && a.name == b.name && a.sources == b.sources &&
         a.attachments == b.attachments && a.quad_size == b.quad_size && a.between == b.between &&
         size_function_text(a) == size_function_text(b);  // numbers that are none, too
}

void check_function(const std::string& text) {
  SizeFunction function;
  try {
    function = parse_size_function(text, model);
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an error has a sentence");
    return;
  }
  try {
    require(is_same(function, parse_size_function(size_function_text(function), model)),
            "what was read, written and read again is the same");
  } catch (const Error& error) {
    require(false, error.what());
  }
  try {
    SizeField field(model);
    field.add(function);
    field.build();
    require(!field.summary().empty(), "a field with a function has a summary");
  } catch (const Error&) {  // what can be read need not be usable
  }
}

void check_entities(const std::string& text) {
  try {
    for (const Entity& entity : parse_entities(text, model)) {
      require(model.contains(entity), "entities that are read are in the model");
    }
  } catch (const Error&) {
  }
}

}  // namespace
}  // namespace meshgrow::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  meshgrow::fuzz::check_function(text);
  meshgrow::fuzz::check_entities(text);
  return 0;
}
