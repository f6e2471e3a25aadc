#include "size_function_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <system_error>
#include <utility>

#include "error.h"
#include "number_text.h"

namespace meshgrow {

namespace {

template <typename Value>
using Choices = std::vector<std::pair<const char*, Value>>;

const Choices<Kind> kind_words = {{"mesh", Kind::mesh},
                                  {"fixed", Kind::fixed},
                                  {"curvature", Kind::curvature},
                                  {"proximity", Kind::proximity}};
const Choices<QuadSize> quad_size_words = {{"triangles", QuadSize::triangles},
                                           {"sides", QuadSize::sides}};
const Choices<GapsBetween> between_words = {
    {"faces", GapsBetween::faces}, {"edges", GapsBetween::edges}, {"both", GapsBetween::both}};

/// The words that a function of this kind takes.
std::vector<std::string> words_of(Kind kind) {
  switch (kind) {
    case Kind::mesh:
      return {"source", "attach", "growth", "limit", "quad_size", "name"};
    case Kind::fixed:
      return {"source", "attach", "size", "growth", "limit", "name"};
    case Kind::curvature:
      return {"source", "attach", "angle", "growth", "limit", "min", "name"};
    default:
      return {"source", "attach", "cells", "between", "growth", "limit", "min", "name"};
  }
}

/// "'a', 'b' or 'c'"
std::string quoted_words(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "'" : i + 1 == words.size() ? " or '" : ", '") + words[i] + "'";
  }
  return text;
}

class Parser {
 public:
  Parser(const std::string& text, const Topology& topology) : text_(text), topology_(topology) {}

  SizeFunction parse() {
    function_.kind = parse_kind();
    for (skip_space(); position_ < text_.size(); skip_space()) {
      const std::size_t begin = position_;
      const std::string word = parse_word();
      if (!parse_common(word) && !parse_own(word)) {
        position_ = begin;
        fail(quoted_words(words_of(function_.kind)));
      }
    }
    require(!function_.sources.empty(), "'source' with entities");
    require(!function_.attachments.empty(), "'attach' with entities");
    require(has_growth_, "'growth' with a number");
    require(function_.size_limit != 0.0, "'limit' with a positive number");
    require(function_.kind != Kind::fixed || function_.start_size != 0.0,
            "'size' with a positive number");
    return std::move(function_);
  }

  std::vector<Entity> parse_only_entities() {
    std::vector<Entity> entities;
    parse_selections(entities);
    skip_space();
    require(position_ == text_.size(), "',' or the end");
    return entities;
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    const std::string found =
        position_ < text_.size() ? "'" + text_.substr(position_, 12) + "'" : "the end";
    throw Error("\"" + text_ + "\": expected " + expected + " at position " +
                std::to_string(position_ + 1) + ", found " + found + ".");
  }

  void require(bool condition, const std::string& expected) const {
    if (!condition) {
      fail(expected);
    }
  }

  void skip_space() {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_]))) {
      ++position_;
    }
  }

  bool accept(char c) {
    skip_space();
    if (position_ < text_.size() && text_[position_] == c) {
      ++position_;
      return true;
    }
    return false;
  }

  std::string parse_word() {
    skip_space();
    std::string word;
    while (
        position_ < text_.size() &&
        (std::isalpha(static_cast<unsigned char>(text_[position_])) || text_[position_] == '_')) {
      word += text_[position_++];
    }
    return word;
  }

  double parse_number(const std::string& expected) {
    skip_space();
    // Not strtod: a decimal point is a point in every locale.
    const std::size_t sign = text_.compare(position_, 1, "+") == 0 ? 1 : 0;
    const char* begin = text_.data() + position_ + sign;
    double value = 0.0;
    const auto [end, problem] = std::from_chars(begin, text_.data() + text_.size(), value);
    require(problem == std::errc(), expected);
    position_ += sign + static_cast<std::size_t>(end - begin);
    return value;
  }

  /// What every kind has. False if the word is something else.
  bool parse_common(const std::string& word) {
    if (word == "source") {
      parse_selections(function_.sources);
    } else if (word == "attach") {
      parse_selections(function_.attachments);
    } else if (word == "growth") {
      function_.growth_rate = parse_number("a growth rate such as 1.2");
      has_growth_ = true;
    } else if (word == "limit") {
      function_.size_limit = parse_number("a size limit");
    } else if (word == "name") {
      function_.name = parse_function_name();
    } else {
      return false;
    }
    return true;
  }

  /// What only some kinds have. False if the word is something else.
  bool parse_own(const std::string& word) {
    const std::vector<std::string> words = words_of(function_.kind);
    if (std::find(words.begin(), words.end(), word) == words.end()) {
      return false;
    }
    if (word == "size") {
      function_.start_size = parse_number("a size");
    } else if (word == "quad_size") {
      function_.quad_size = parse_choice(quad_size_words);
    } else if (word == "angle") {
      function_.angle = parse_number("an angle in degrees such as 18");
    } else if (word == "cells") {
      function_.cells_per_gap = parse_number("a number of cells such as 3");
    } else if (word == "between") {
      function_.between = parse_choice(between_words);
    } else {
      function_.min_size = parse_number("a smallest size");
    }
    return true;
  }

  Kind parse_kind() { return parse_choice(kind_words); }

  template <typename Value>
  Value parse_choice(const Choices<Value>& choices) {
    skip_space();
    const std::size_t begin = position_;
    const std::string word = parse_word();
    std::vector<std::string> words;
    for (const auto& [name, value] : choices) {
      if (word == name) {
        return value;
      }
      words.emplace_back(name);
    }
    position_ = begin;
    fail(quoted_words(words));
  }

  void parse_selections(std::vector<Entity>& entities) {
    // What is named over and over takes no more room.
    std::set<Entity> selected(entities.begin(), entities.end());
    do {
      parse_selection(selected);
    } while (accept(','));
    entities.assign(selected.begin(), selected.end());
  }

  void parse_selection(std::set<Entity>& entities) {
    skip_space();
    std::size_t begin = position_;
    std::string word = parse_word();
    const bool physical = word == "Physical";
    if (physical) {
      skip_space();
      begin = position_;
      word = parse_word();
    }
    const int dim = word == "Point"                     ? 0
                    : word == "Curve" || word == "Line" ? 1
                    : word == "Surface"                 ? 2
                    : word == "Volume"                  ? 3
                                                        : -1;
    if (dim < 0) {
      position_ = begin;
      fail("Point, Curve, Surface or Volume");
    }
    require(accept('{'), "'{'");
    do {
      if (physical) {
        parse_physical_item(dim, entities);
      } else {
        parse_item(dim, entities);
      }
    } while (accept(','));
    require(accept('}'), "',' or '}'");
  }

  int parse_tag() {
    skip_space();
    const std::size_t begin = position_;
    const double value = parse_number("a tag or ':'");
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value)) {
      position_ = begin;
      fail("a whole number");
    }
    return static_cast<int>(value);
  }

  void parse_item(int dim, std::set<Entity>& entities) {
    const std::vector<Entity> all = topology_.entities(dim);
    if (accept(':')) {
      entities.insert(all.begin(), all.end());
      return;
    }
    const int first = parse_tag();
    if (!accept(':')) {
      if (!topology_.contains({dim, first})) {
        throw Error("\"" + text_ + "\": " + entity_name({dim, first}) +
                    " is not in the model: check dimension and tag.");
      }
      entities.insert({dim, first});
      return;
    }
    // As in .geo, a range names whole numbers; of these, the entities that exist are taken.
    const int last = parse_tag();
    bool found = false;
    for (const Entity& entity : all) {
      if (entity.tag >= first && entity.tag <= last) {
        entities.insert(entity);
        found = true;
      }
    }
    if (!found) {
      throw Error("\"" + text_ + "\": the model has no " + dimension_name(dim) + " from " +
                  std::to_string(first) + " to " + std::to_string(last) + ": check the tags.");
    }
  }

  std::string parse_name() {
    skip_space();
    const bool quoted = accept('"');
    std::string name;
    while (
        position_ < text_.size() &&
        (quoted ? text_[position_] != '"' : text_[position_] != ',' && text_[position_] != '}')) {
      name += text_[position_++];
    }
    if (quoted) {
      require(accept('"'), "'\"'");
    } else {
      name.erase(name.find_last_not_of(" \t") + 1);
    }
    require(!name.empty(), "the tag or name of a physical group");
    return name;
  }

  std::string parse_function_name() {
    skip_space();
    const std::size_t begin = position_;
    const bool quoted = accept('"');
    std::string name;
    while (position_ < text_.size() &&
           (quoted ? text_[position_] != '"'
                   : std::isspace(static_cast<unsigned char>(text_[position_])) == 0)) {
      name += text_[position_++];
    }
    const bool closed = !quoted || accept('"');
    if (!closed || name.empty() || is_number_name(name) || name.find('"') != std::string::npos) {
      position_ = begin;
      fail("a name that is not a number and has no quotes");
    }
    return name;
  }

  void parse_physical_item(int dim, std::set<Entity>& entities) {
    if (accept(':')) {
      for (const PhysicalGroup& group : topology_.physical_groups()) {
        if (group.dim == dim) {
          entities.insert(group.entities.begin(), group.entities.end());
        }
      }
      return;
    }
    const std::string name = parse_name();
    bool found = false;
    for (const PhysicalGroup& group : topology_.physical_groups()) {
      if (group.dim == dim && (group.name == name || std::to_string(group.tag) == name)) {
        entities.insert(group.entities.begin(), group.entities.end());
        found = true;
      }
    }
    if (!found) {
      throw Error("\"" + text_ + "\": the model has no Physical " + dimension_name(dim) + " \"" +
                  name + "\": check its name and dimension.");
    }
  }

  const std::string& text_;
  const Topology& topology_;
  std::size_t position_ = 0;
  SizeFunction function_;
  bool has_growth_ = false;
};

template <typename Value>
std::string word_of(Value value, const Choices<Value>& choices) {
  return std::find_if(choices.begin(), choices.end(),
                      [value](const auto& choice) { return choice.second == value; })
      ->first;
}

/// "Surface{7,9}, Volume{2}": sorted, each once, as they are read.
std::string selection_text(const std::vector<Entity>& entities) {
  std::string text;
  int dim = -1;
  for (const Entity& entity : std::set<Entity>(entities.begin(), entities.end())) {
    if (entity.dim == dim) {
      text.back() = ',';
    } else {
      text += (text.empty() ? "" : ", ") + dimension_name(entity.dim) + "{";
    }
    text += std::to_string(entity.tag) + "}";
    dim = entity.dim;
  }
  return text;
}

std::string own_text(const SizeFunction& function) {
  const SizeFunction standard;
  std::string text;
  if (function.kind == Kind::fixed) {
    text += " size " + exact_text(function.start_size);
  }
  if (function.kind == Kind::mesh && function.quad_size != standard.quad_size) {
    text += " quad_size " + word_of(function.quad_size, quad_size_words);
  }
  if (function.kind == Kind::curvature) {
    text += " angle " + exact_text(function.angle);
  }
  if (function.kind == Kind::proximity) {
    text += " cells " + exact_text(function.cells_per_gap);
    if (function.between != GapsBetween::automatic) {
      text += " between " + word_of(function.between, between_words);
    }
  }
  return text;
}

}  // namespace

SizeFunction parse_size_function(const std::string& text, const Topology& topology) {
  return Parser(text, topology).parse();
}

std::string size_function_text(const SizeFunction& function) {
  const bool has_min = function.kind == Kind::curvature || function.kind == Kind::proximity;
  return kind_name(function.kind) + " source " + selection_text(function.sources) + " attach " +
         selection_text(function.attachments) + own_text(function) + " growth " +
         exact_text(function.growth_rate) + " limit " + exact_text(function.size_limit) +
         (has_min && function.min_size != 0.0 ? " min " + exact_text(function.min_size) : "") +
         (function.name.empty() || is_number_name(function.name)
              ? ""
              : " name \"" + function.name + '"');
}

std::vector<Entity> parse_entities(const std::string& text, const Topology& topology) {
  return Parser(text, topology).parse_only_entities();
}

}  // namespace meshgrow
