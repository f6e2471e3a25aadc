#include "size_function_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "error.h"

namespace meshgrow {

namespace {

class Parser {
 public:
  Parser(const std::string& text, const Topology& topology) : text_(text), topology_(topology) {}

  SizeFunction parse() {
    SizeFunction function;
    function.kind = parse_kind();
    bool has_growth = false;
    for (skip_space(); position_ < text_.size(); skip_space()) {
      const std::size_t begin = position_;
      const std::string word = parse_word();
      if (word == "source") {
        parse_selections(function.sources);
      } else if (word == "attach") {
        parse_selections(function.attachments);
      } else if (word == "growth") {
        function.growth_rate = parse_number("a growth rate such as 1.2");
        has_growth = true;
      } else if (word == "limit") {
        function.size_limit = parse_number("a size limit");
      } else if (word == "size" && function.kind == Kind::fixed) {
        function.start_size = parse_number("a size");
      } else if (word == "quad_size" && function.kind == Kind::mesh) {
        function.quad_size = parse_quad_size();
      } else {
        position_ = begin;
        fail(function.kind == Kind::fixed ? "'source', 'attach', 'size', 'growth' or 'limit'"
                                          : "'source', 'attach', 'growth', 'limit' or 'quad_size'");
      }
    }
    require(!function.sources.empty(), "'source' with entities");
    require(!function.attachments.empty(), "'attach' with entities");
    require(has_growth, "'growth' with a number");
    require(function.size_limit != 0.0, "'limit' with a positive number");
    require(function.kind != Kind::fixed || function.start_size != 0.0,
            "'size' with a positive number");
    return function;
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

  Kind parse_kind() {
    skip_space();
    const std::size_t begin = position_;
    const std::string word = parse_word();
    if (word == "mesh") {
      return Kind::mesh;
    }
    if (word == "fixed") {
      return Kind::fixed;
    }
    position_ = begin;
    fail("'mesh' or 'fixed'");
  }

  QuadSize parse_quad_size() {
    skip_space();
    const std::size_t begin = position_;
    const std::string word = parse_word();
    if (word == "triangles") {
      return QuadSize::triangles;
    }
    if (word == "sides") {
      return QuadSize::sides;
    }
    position_ = begin;
    fail("'triangles' or 'sides'");
  }

  void parse_selections(std::vector<Entity>& entities) {
    do {
      parse_selection(entities);
    } while (accept(','));
    std::sort(entities.begin(), entities.end());
    entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
  }

  void parse_selection(std::vector<Entity>& entities) {
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

  void parse_item(int dim, std::vector<Entity>& entities) {
    const std::vector<Entity> all = topology_.entities(dim);
    if (accept(':')) {
      entities.insert(entities.end(), all.begin(), all.end());
      return;
    }
    const int first = parse_tag();
    if (!accept(':')) {
      if (!topology_.contains({dim, first})) {
        throw Error("\"" + text_ + "\": " + entity_name({dim, first}) +
                    " is not in the model: check dimension and tag.");
      }
      entities.push_back({dim, first});
      return;
    }
    // As in .geo, a range names whole numbers; of these, the entities that exist are taken.
    const int last = parse_tag();
    bool found = false;
    for (const Entity& entity : all) {
      if (entity.tag >= first && entity.tag <= last) {
        entities.push_back(entity);
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

  void parse_physical_item(int dim, std::vector<Entity>& entities) {
    if (accept(':')) {
      for (const PhysicalGroup& group : topology_.physical_groups()) {
        if (group.dim == dim) {
          entities.insert(entities.end(), group.entities.begin(), group.entities.end());
        }
      }
      return;
    }
    const std::string name = parse_name();
    bool found = false;
    for (const PhysicalGroup& group : topology_.physical_groups()) {
      if (group.dim == dim && (group.name == name || std::to_string(group.tag) == name)) {
        entities.insert(entities.end(), group.entities.begin(), group.entities.end());
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
};

}  // namespace

SizeFunction parse_size_function(const std::string& text, const Topology& topology) {
  return Parser(text, topology).parse();
}

std::vector<Entity> parse_entities(const std::string& text, const Topology& topology) {
  return Parser(text, topology).parse_only_entities();
}

}  // namespace meshgrow
