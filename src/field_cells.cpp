#include "field_cells.h"

#include <algorithm>
#include <cmath>

#include "attached_region.h"
#include "error.h"
#include "number_text.h"

namespace meshgrow {

namespace {

/// For points on curved boundaries that bulge out of a box told too small, and for rounding: of
/// each side, and of the diagonal (a flat model has no third side).
constexpr double margin_of_side = 0.01;
constexpr double margin_of_diagonal = 0.001;

Box enlarged(const Box& box) {
  const Vec3 margin =
      margin_of_side * box.sizes() + Vec3::Constant(margin_of_diagonal * box.diagonal().norm());
  return Box(box.min() - margin, box.max() + margin);
}

/// Cells beside the box, in the cube around it, need no refinement.
std::shared_ptr<const AttachedRegion> region_of(const Box& box) {
  const auto corner = [&box](int i) { return Vec3(box.corner(static_cast<Box::CornerType>(i))); };
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& [a, b, c, d] : {std::array<int, 4>{0, 1, 3, 2},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 3, 7, 6},
                                   {0, 2, 6, 4},
                                   {1, 3, 7, 5}}) {
    triangles.push_back({corner(a), corner(b), corner(c)});
    triangles.push_back({corner(a), corner(c), corner(d)});
  }
  return std::make_shared<AttachedRegion>(triangles);
}

std::shared_ptr<const BackgroundGrid> built_aside(const SizeField::Answering& answering,
                                                  const Box& box, const FieldOptions& field_options,
                                                  CellUse use) {
  GridOptions options;
  options.tolerance = field_options.tolerance;
  options.threads = field_options.threads;
  options.max_cells = field_options.max_cells;
  if (use == CellUse::interpolate) {
    options.facets_per_exact_leaf = 0;
    options.region = region_of(box);
  }
  if (field_options.progress) {
    options.progress = [&field_options](double done) {
      field_options.progress("Cells of the size field", done);
    };
  }
  auto grid = std::make_shared<BackgroundGrid>(answering.tree, answering.size_limit, box, options);
  const BackgroundGrid::Statistics& statistics = grid->statistics();
  if (use == CellUse::interpolate && statistics.is_limited && field_options.warn) {
    field_options.warn("The size field needs more than " + grouped_digits(statistics.max_cells) +
                       " cells and is coarser than it should be: interpolated sizes are within " +
                       rounded(100.0 * statistics.tolerance, 0) + " % instead of " +
                       rounded(100.0 * options.tolerance, 0) +
                       " %; raise max_cells or the tolerance.");
  }
  return grid;
}

/// What is shown need not be as good as what is answered: at least so much may it differ, and this
/// many times the tolerance of the field.
constexpr double least_shown_tolerance = 0.1;
constexpr double shown_tolerances = 2.0;

constexpr int most_divisions = 8;

/// Appends cells in which facets answer, with exact sizes at their corners.
class ExactCells {
 public:
  ExactCells(const SizeField::Answering& answering, const Box& box, double tolerance,
             FieldCells& result)
      : answering_(answering),
        box_(box),
        tolerance_(std::max(least_shown_tolerance, shown_tolerances * tolerance)),
        result_(result) {}

  void append(FieldCell cell) {
    cell.exact = true;
    std::array<Vec3, 8> corners;
    std::array<double, 8> sizes;
    for (int i = 0; i < 8; ++i) {
      corners[i] = result_.corner(cell, i);
    }
    answering_.tree->sizes(corners.data(), 8, answering_.size_limit, sizes.data());
    std::transform(sizes.begin(), sizes.end(), cell.sizes.begin(),
                   [](double size) { return static_cast<float>(size); });
    result_.cells.push_back(cell);
  }

  void append_divided(const FieldCell& cell, int most) {
    if (!box_.intersects(Box(result_.corner(cell, 0), result_.corner(cell, 7)))) {
      return;
    }
    GridCell asked;
    asked.lowest = cell.lowest;
    asked.depth = cell.depth;
    if (most == 0 || cell.depth == max_grid_depth) {
      append(cell);
      return;
    }
    std::array<Vec3, 27> points;
    Lattice sizes;
    for (int i = 0; i < 27; ++i) {
      points[i] = result_.cube.at(lattice_place(asked, i));
    }
    answering_.tree->sizes(points.data(), 27, answering_.size_limit, sizes.data());
    FieldCell shown = cell;
    shown.exact = true;
    for (int i = 0; i < 8; ++i) {
      shown.sizes[i] = static_cast<float>(sizes[lattice_index_of_corner(i)]);
    }
    bool differs = false;
    for (int i = 0; i < 27; ++i) {
      const double between =
          trilinear(shown.sizes, 0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9));
      differs = differs || std::abs(between - sizes[i]) > tolerance_ * sizes[i];
    }
    if (!differs) {
      result_.cells.push_back(shown);
      return;
    }
    for (int child = 0; child < 8; ++child) {
      shown.lowest = child_cell(asked, child, sizes).lowest;
      shown.depth = static_cast<std::uint8_t>(cell.depth + 1);
      append_divided(shown, most - 1);
    }
  }

 private:
  const SizeField::Answering& answering_;
  const Box& box_;
  double tolerance_;
  FieldCells& result_;
};

/// Groups that decide at the centres.
void find_groups(const SizeField& field, FieldCells& cells) {
  constexpr std::size_t at_once = 1024;
  std::vector<Vec3> centres;
  std::vector<double> sizes(at_once);
  std::vector<std::size_t> groups(at_once);
  for (std::size_t first = 0; first < cells.cells.size(); first += at_once) {
    const std::size_t end = std::min(first + at_once, cells.cells.size());
    centres.clear();
    for (std::size_t i = first; i < end; ++i) {
      const FieldCell& cell = cells.cells[i];
      centres.push_back(0.5 * (cells.corner(cell, 0) + cells.corner(cell, 7)));
    }
    field.smallest_sizes(centres.data(), centres.size(), sizes.data(), groups.data());
    for (std::size_t i = first; i < end; ++i) {
      cells.cells[i].group = static_cast<std::uint32_t>(groups[i - first]);
    }
  }
}

}  // namespace

LatticePlace FieldCells::corner_place(const FieldCell& cell, int corner) const {
  const std::uint32_t steps = 1u << (max_grid_depth - cell.depth);
  return {cell.lowest.x + (corner & 1 ? steps : 0), cell.lowest.y + (corner & 2 ? steps : 0),
          cell.lowest.z + (corner & 4 ? steps : 0)};
}

FieldCells field_cells(const SizeField& field, const std::optional<Entity>& entity, CellUse use) {
  const SizeField::Answering answering =
      entity ? field.answering(*entity) : field.answering_together();
  if (!answering.tree || answering.size_limit == SizeField::no_size) {
    throw Error((entity ? "No size function acts on " + entity_name(*entity)
                        : std::string("No size function acts")) +
                ": add one whose sources have a mesh.");
  }
  if (answering.box.isEmpty()) {
    throw Error((entity ? entity_name(*entity) : std::string("The model")) +
                " has no extent in space: mesh it first.");
  }
  const Box box = use == CellUse::interpolate ? enlarged(answering.box) : answering.box;
  const std::shared_ptr<const BackgroundGrid> grid =
      use == CellUse::show && answering.grid ? answering.grid
                                             : built_aside(answering, box, field.options(), use);
  FieldCells result;
  result.cube = grid->grid_cube();
  ExactCells exact_cells(answering, box, field.options().tolerance, result);
  grid->for_each_leaf([&](const GridLeaf& leaf) {
    FieldCell cell;
    cell.lowest = leaf.lowest;
    cell.depth = static_cast<std::uint8_t>(leaf.depth);
    cell.group = static_cast<std::uint32_t>(answering.group);
    if (!box.intersects(Box(result.corner(cell, 0), result.corner(cell, 7)))) {
      return;
    }
    if (leaf.sizes != nullptr) {
      cell.sizes = *leaf.sizes;
      result.cells.push_back(cell);
    } else if (leaf.keeps_facets) {
      exact_cells.append_divided(cell, most_divisions);
    } else {
      exact_cells.append(cell);
    }
  });
  for (FieldCell& cell : result.cells) {
    const Box around(result.corner(cell, 0), result.corner(cell, 7));
    for (const auto& [reach, size] : answering.inside) {
      if (reach.intersects(around)) {
        for (float& at_corner : cell.sizes) {
          at_corner = std::min(at_corner, static_cast<float>(size));
        }
      }
    }
  }
  if (!entity && field.groups().size() > 1) {
    find_groups(field, result);
  }
  return result;
}

SharedNodes shared_nodes(const FieldCells& cells) {
  std::vector<std::uint64_t> keys;
  keys.reserve(8 * cells.cells.size());
  for (const FieldCell& cell : cells.cells) {
    for (int i = 0; i < 8; ++i) {
      keys.push_back(cells.corner_place(cell, i).key());
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  if (keys.size() > 0xFFFFFFFFu) {
    throw Error("The size field has over four billion nodes: raise its tolerance.");
  }
  SharedNodes nodes;
  nodes.places.resize(keys.size());
  nodes.sizes.assign(keys.size(), std::numeric_limits<float>::infinity());
  nodes.of_cell.reserve(cells.cells.size());
  for (const FieldCell& cell : cells.cells) {
    std::array<std::uint32_t, 8> of_cell;
    for (int i = 0; i < 8; ++i) {
      const int corner = hexahedron_corners[i];
      const LatticePlace place = cells.corner_place(cell, corner);
      const auto found = std::lower_bound(keys.begin(), keys.end(), place.key());
      const auto node = static_cast<std::uint32_t>(found - keys.begin());
      nodes.places[node] = place;
      nodes.sizes[node] = std::min(nodes.sizes[node], cell.sizes[corner]);
      of_cell[i] = node;
    }
    nodes.of_cell.push_back(of_cell);
  }
  return nodes;
}

}  // namespace meshgrow
