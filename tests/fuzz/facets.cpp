// Facets as they come from the arrays of a mesh, any doubles: start sizes, exact sizes, probes and
// grids of them are numbers that make sense.

#include <algorithm>
#include <cmath>
#include <vector>

#include "error.h"
#include "fuzz_target.h"
#include "input_numbers.h"
#include "size_field.h"

namespace meshgrow::fuzz {
namespace {

const Entity volume = {3, 1};
const Entity faces[] = {{2, 1}, {2, 2}};

constexpr std::size_t most_facets = 40;
constexpr std::size_t most_walls = 4;

/// Of grids, relative to the size: what is proven in float.
constexpr double rounding = 1e-5;

/// What the input says, in the order of its bytes.
struct Model {
  SizeFunction function;
  double tolerance = 0.05;
  Box box;
  std::vector<Vec3> points;
  std::vector<FacetedSource> sources;
};

SizeFunction read_function(InputNumbers& input) {
  SizeFunction function;
  const unsigned choice = input.byte();
  function.kind = static_cast<Kind>(choice % 4);
  function.quad_size = (choice & 4) != 0 ? QuadSize::sides : QuadSize::triangles;
  function.between = GapsBetween::faces;
  function.sources = {faces[0], faces[1]};
  function.attachments = {volume};
  function.growth_rate = input.number();
  function.size_limit = input.number();
  function.start_size = input.number();
  if ((choice & 8) != 0) {
    function.angle = input.number();
    function.cells_per_gap = input.number();
    function.min_size = input.number();
  }
  return function;
}

void read_facet(InputNumbers& input, Model& model) {
  const unsigned choice = input.byte();
  FacetedSource& source = model.sources[choice >> 7];
  const Vec3 a = input.point();
  if (choice % 4 == 0) {
    source.points.push_back(a);
    return;
  }
  const Vec3 b = input.point();
  if (choice % 4 == 1) {
    source.segments.push_back({a, b});
    return;
  }
  const Vec3 c = input.point();
  if (choice % 4 == 2) {
    source.triangles.push_back({a, b, c});
  } else {
    source.quads.push_back({a, b, c, input.point()});
  }
}

Model read_model(InputNumbers& input) {
  Model model;
  model.function = read_function(input);
  static constexpr double tolerances[] = {0.05, 0.2, 0.5, 1.0};
  const unsigned choice = input.byte();
  model.tolerance = tolerances[choice % 4];
  if ((choice & 4) != 0) {
    const Vec3 corner = input.point();
    model.box = Box(corner, input.point());
  }
  for (unsigned i = 0; i < choice >> 6; ++i) {
    model.points.push_back(input.point());
  }
  model.sources.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    model.sources[i].entity = faces[i];
  }
  const bool is_proximity = model.function.kind == Kind::proximity;
  for (std::size_t i = 0; i < (is_proximity ? most_walls : most_facets) && !input.at_end(); ++i) {
    read_facet(input, model);
  }
  if ((choice & 8) != 0) {
    // As the geometry tells them.
    for (FacetedSource& source : model.sources) {
      source.segment_curvatures.assign(source.segments.size(), input.number());
      const std::size_t halves = source.triangles.size() + 2 * source.quads.size();
      source.triangle_curvatures.assign(halves, input.number());
    }
  }
  return model;
}

/// Walls are cut into pieces as small as the size limit asks for: how many is up to the user.
bool asks_for_few_pieces(const Model& model) {
  Box box;
  for (const FacetedSource& source : model.sources) {
    for (const auto& triangle : source.triangles) {
      box.extend(Facet::triangle(triangle[0], triangle[1], triangle[2]).box());
    }
    for (const auto& quad : source.quads) {
      for (const Vec3& corner : quad) {
        box.extend(corner);
      }
    }
  }
  return box.isEmpty() || box.sizes().maxCoeff() <= 4.0 * model.function.size_limit;
}

/// Whether it can be added.
bool add(const Model& model, SizeField& field) {
  try {
    field.add(model.function);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void give_sources(const Model& model, SizeField& field) {
  if (model.function.kind != Kind::proximity) {
    field.set_sources(0, model.sources);
    return;
  }
  std::vector<WalledRegion> regions;
  for (const GapRegion& gaps : gap_regions(model.function, field.topology())) {
    regions.push_back({gaps, volume_walls(model.sources)});
  }
  field.set_regions(0, regions);
}

/// Where answers may be odd: corners, and what lies between and beyond them.
std::vector<Vec3> interesting_points(const Model& model, const FacetTree& tree) {
  std::vector<Vec3> points = model.points;
  points.push_back(Vec3::Zero());
  if (!model.box.isEmpty()) {
    points.push_back(model.box.center());
    points.push_back(model.box.max());
  }
  Vec3 before = Vec3::Zero();
  for (std::size_t i = 0; i < tree.facets().size(); i += 1 + tree.facets().size() / 4) {
    const Vec3& corner = tree.facets()[i].facet.corners[i % 3];
    points.push_back(corner);
    points.emplace_back(0.5 * corner + 0.5 * before);
    points.emplace_back(2.0 * corner - before);
    before = corner;
  }
  return points;
}

/// Sizes and places whose squares and quotients double can hold with all digits.
bool is_moderate(double x) { return x == 0.0 || (std::abs(x) > 1e-60 && std::abs(x) < 1e60); }

bool is_moderate(const FacetTree& tree, const Vec3& p) {
  const auto all_moderate = [](const Vec3& v) {
    return is_moderate(v.x()) && is_moderate(v.y()) && is_moderate(v.z());
  };
  return all_moderate(p) &&
         std::all_of(tree.facets().begin(), tree.facets().end(), [&](const SizedFacet& sized) {
           const auto& corners = sized.facet.corners;
           return is_moderate(sized.start_size) &&
                  std::all_of(corners.begin(), corners.end(), all_moderate);
         });
}

void check_exact_size(const FacetTree& tree, double limit, const Vec3& p, double exact) {
  require(exact > 0.0, "sizes are positive");
  require(exact <= limit, "no size is above the limit");
  if (is_moderate(tree, p)) {
    double expected = limit;
    for (const SizedFacet& facet : tree.facets()) {
      expected = std::min(expected, facet.size_at(p));
    }
    require(std::abs(exact - expected) <= 1e-12 * expected,
            "the exact size is the least over all facets");
  }
}

/// By Lipschitz' bound no cell is divided further than this asks for, whatever the facets are.
bool is_quick_to_divide(const FacetTree& tree, const Box& box, double tolerance) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const SizedFacet& facet : tree.facets()) {
    smallest = std::min(smallest, facet.start_size);
  }
  return tree.largest_slope() * box.sizes().maxCoeff() <= 6.0 * tolerance * smallest;
}

void check_grid(const std::shared_ptr<const FacetTree>& tree, double limit, const Model& model,
                const std::vector<Vec3>& points) {
  GridOptions options;
  options.tolerance = model.tolerance;
  options.threads = 1;
  if (is_quick_to_divide(*tree, model.box, model.tolerance)) {
    options.facets_per_exact_leaf = 1;
  }
  const BackgroundGrid grid(tree, limit, model.box, options);
  for (const Vec3& p : points) {
    if (p.allFinite()) {
      const double exact = tree->size(p, limit);
      const double size = grid.size(p);
      require(size > 0.0, "sizes of a grid are positive");
      if (!(size <= exact * (1.0 + model.tolerance) * (1.0 + rounding))) {
        std::fprintf(stderr, "%.17g in a grid, %.17g exact, at (%.17g, %.17g, %.17g).\n", size,
                     exact, p.x(), p.y(), p.z());
        require(false, "no size of a grid is above the exact one by more than the tolerance");
      }
    }
  }
}

void check(InputNumbers input) {
  const Model model = read_model(input);
  if (model.function.kind == Kind::proximity && !asks_for_few_pieces(model)) {
    return;
  }
  Topology topology;
  topology.add_entity(faces[0], {}, model.box);
  topology.add_entity(faces[1], {}, model.box);
  topology.add_entity(volume, {faces[0], faces[1]}, model.box);
  FieldOptions options;
  options.tolerance = model.tolerance;
  options.threads = 1;
  options.evaluator = Evaluator::grid;
  SizeField field(topology, options);
  if (!add(model, field)) {
    return;
  }
  give_sources(model, field);
  field.build_trees();
  const SizeField::Answering answering = field.answering(volume);
  require(answering.tree != nullptr, "what was built has a tree");
  const std::vector<Vec3> points = interesting_points(model, *answering.tree);
  const double limit = answering.size_limit;
  for (const Vec3& p : points) {
    const double exact = field.exact_size(volume, p);
    if (!p.allFinite() || limit == SizeField::no_size) {
      require(exact == SizeField::no_size, "there are no sizes where nothing acts");
      continue;
    }
    check_exact_size(*answering.tree, limit, p, exact);
    require(field.probe(volume, p).size == exact, "a probe tells the size");
  }
  if (limit < SizeField::no_size && model.box.min().allFinite() && model.box.max().allFinite()) {
    check_grid(answering.tree, limit, model, points);
  }
  field.build();
  require(!field.summary().empty(), "a field with a function has a summary");
}

}  // namespace
}  // namespace meshgrow::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  meshgrow::fuzz::check(meshgrow::fuzz::InputNumbers(data, size));
  return 0;
}
