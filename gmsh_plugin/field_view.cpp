#include "field_view.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "error.h"
#include "field_cells.h"
#include "field_files.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "gmsh_views.h"
#include "plane_cut.h"
#include "whole_file.h"

namespace meshgrow {

namespace {

namespace fs = std::filesystem;

std::string whose(const std::optional<Entity>& entity) {
  return entity ? entity_name(*entity) : std::string("the model");
}

void check_entity(const SizeField& field, const std::optional<Entity>& entity) {
  if (entity && !field.topology().contains(*entity)) {
    throw Error(entity_name(*entity) + " is not in the model: check its dimension and tag.");
  }
}

void check_some_size(const SizeField& field, const std::optional<Entity>& entity) {
  if (entity ? !field.acts_on(*entity) : field.groups().empty()) {
    throw Error((entity ? "No size function acts on " + entity_name(*entity)
                        : std::string("No size function acts")) +
                ": add one, or show another entity.");
  }
}

void sizes_at(const SizeField& field, const std::optional<Entity>& entity,
              const std::vector<Vec3>& points, double* sizes) {
  if (entity) {
    field.sizes(*entity, points.data(), points.size(), sizes);
  } else {
    field.smallest_sizes(points.data(), points.size(), sizes);
  }
}

/// A view that vanishes again unless it is finished.
class NewView {
 public:
  explicit NewView(const std::string& name) : tag_(gmsh::add_view(name)) {}
  ~NewView() {
    if (tag_ >= 0) {
      try {
        gmsh::remove_view(tag_);
      } catch (...) {
        // The failure that leads here is the one to be told.
      }
    }
  }
  NewView(const NewView&) = delete;
  NewView& operator=(const NewView&) = delete;

  int tag() const { return tag_; }
  int finish() { return std::exchange(tag_, -1); }

 private:
  int tag_;
};

/// Appends x, y, z and values of the nodes of an element.
template <std::size_t count>
void append_element(const std::array<Vec3, count>& nodes, const std::array<double, count>& values,
                    std::vector<double>& data) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const Vec3& node : nodes) {
      data.push_back(node[axis]);
    }
  }
  data.insert(data.end(), values.begin(), values.end());
}

int add_cells(const SizeField& field, const ViewRequest& request) {
  const FieldCells cells = field_cells(field, request.entity, CellUse::show);
  if (cells.cells.size() > std::numeric_limits<int>::max() / 32) {
    throw Error("The size field has " + std::to_string(cells.cells.size()) +
                " cells, too many for a view of Gmsh: raise its tolerance.");
  }
  std::vector<double> data;
  data.reserve(32 * cells.cells.size());
  for (const FieldCell& cell : cells.cells) {
    std::array<Vec3, 8> nodes;
    std::array<double, 8> values;
    for (int i = 0; i < 8; ++i) {
      nodes[i] = cells.corner(cell, hexahedron_corners[i]);
      values[i] = cell.sizes[hexahedron_corners[i]];
    }
    append_element(nodes, values, data);
  }
  NewView view(request.name);
  gmsh::add_list_data(view.tag(), "SH", cells.cells.size(), data);
  return view.finish();
}

Box box_of(const SizeField& field, const std::optional<Entity>& entity) {
  if (entity) {
    return field.topology().box(*entity);
  }
  Box box;
  for (const Entity& each : field.topology().entities()) {
    box.extend(field.topology().box(each));
  }
  return box;
}

CutPlane default_plane(const Box& box) {
  const Vec3 sides = box.sizes();
  int axis = 2;
  for (const int other : {0, 1}) {
    if (sides[other] < (1.0 - 1e-6) * sides[axis]) {
      axis = other;
    }
  }
  return {box.center(), Vec3::Unit(axis)};
}

/// Sizes from grids jump a little from cell to cell: that is nothing to divide squares for.
double plane_tolerance(const SizeField& field) {
  constexpr double smooth = 0.01;
  const std::vector<SizeField::GroupSummary> groups = field.groups();
  const bool has_grid =
      std::any_of(groups.begin(), groups.end(), [](const auto& group) { return group.has_grid; });
  return has_grid ? std::max(smooth, field.options().tolerance) : smooth;
}

int add_plane(const SizeField& field, const ViewRequest& request) {
  const Box box = box_of(field, request.entity);
  if (box.isEmpty()) {
    throw Error(entity_name(request.entity.value_or(Entity())) +
                " has no extent in space: mesh it first.");
  }
  const CutPlane plane = request.plane.value_or(default_plane(box));
  if (!plane.point.allFinite() || !plane.normal.allFinite() || plane.normal.norm() == 0.0) {
    throw Error(
        "The plane of the view has no finite point and normal: give both, such as "
        "(0, 0, 0) and (0, 0, 1).");
  }
  if (request.resolution < 1 || request.resolution > 1000) {
    throw Error("The resolution of the view is " + std::to_string(request.resolution) +
                ": give a number from 1 to 1000.");
  }
  const std::vector<CutSquare> squares =
      cut_by_plane(box, plane.point, plane.normal, request.resolution, plane_tolerance(field),
                   [&](const std::vector<Vec3>& points, double* sizes) {
                     sizes_at(field, request.entity, points, sizes);
                   });
  if (squares.empty()) {
    throw Error("The plane of the view shows no sizes of " + whose(request.entity) +
                ": choose one that cuts its box, and size functions whose sources have a mesh.");
  }
  std::vector<double> data;
  for (const CutSquare& square : squares) {
    append_element(square.corners, square.sizes, data);
  }
  NewView view(request.name);
  gmsh::add_list_data(view.tag(), "SQ", squares.size(), data);
  return view.finish();
}

/// All nodes of the model with the smallest size of all groups.
int add_nodes(const SizeField& field, const std::string& model, const std::string& name) {
  const gmsh::Nodes nodes = gmsh::all_nodes();
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < nodes.tags.size(); ++i) {
    points.emplace_back(nodes.coordinates[3 * i], nodes.coordinates[3 * i + 1],
                        nodes.coordinates[3 * i + 2]);
  }
  std::vector<double> sizes(points.size());
  sizes_at(field, std::nullopt, points, sizes.data());
  std::vector<std::size_t> tags;
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(sizes[i])) {
      tags.push_back(nodes.tags[i]);
      values.push_back(sizes[i]);
    }
  }
  if (tags.empty()) {
    throw Error("The model has no mesh with sizes to show: mesh it first, or show \"cells\".");
  }
  NewView view(name);
  gmsh::add_node_data(view.tag(), model, tags, values);
  return view.finish();
}

/// The elements of an entity with its own sizes at their nodes.
int add_elements(const SizeField& field, const Entity& entity, const std::string& model,
                 const std::string& name) {
  const NodeCoordinates coordinates(field.topology().closure({entity}));
  std::vector<std::size_t> tags;
  std::vector<std::vector<double>> values;
  std::vector<Vec3> points;
  for (const gmsh::Elements& elements : gmsh::elements(entity)) {
    const auto node_count = static_cast<std::size_t>(gmsh::element_type(elements.type).node_count);
    for (std::size_t i = 0; i < elements.tags.size(); ++i) {
      points.clear();
      for (std::size_t k = 0; k < node_count; ++k) {
        points.push_back(coordinates.at(elements.node_tags[i * node_count + k], entity));
      }
      std::vector<double> sizes(node_count);
      sizes_at(field, entity, points, sizes.data());
      if (std::all_of(sizes.begin(), sizes.end(), [](double s) { return std::isfinite(s); })) {
        tags.push_back(elements.tags[i]);
        values.push_back(std::move(sizes));
      }
    }
  }
  if (tags.empty()) {
    throw Error(entity_name(entity) +
                " has no mesh with sizes to show: mesh it first, or show \"cells\".");
  }
  NewView view(name);
  gmsh::add_element_node_data(view.tag(), model, tags, values);
  return view.finish();
}

std::string ending_of(const std::string& path) { return fs::path(path).extension().string(); }

}  // namespace

ViewKind view_kind(const std::string& name) {
  if (name == "cells") {
    return ViewKind::cells;
  }
  if (name == "plane") {
    return ViewKind::plane;
  }
  if (name == "mesh") {
    return ViewKind::mesh;
  }
  throw Error("There is no view of kind \"" + name + "\": give \"cells\", \"plane\" or \"mesh\".");
}

int add_view(ModelField& model_field, const ViewRequest& request) {
  const SizeField& field = model_field.field();
  check_entity(field, request.entity);
  model_field.refresh_if_needed();
  check_some_size(field, request.entity);
  const CurrentModel current(model_field.model());
  if (request.kind == ViewKind::cells) {
    return add_cells(field, request);
  }
  if (request.kind == ViewKind::plane) {
    return add_plane(field, request);
  }
  return request.entity ? add_elements(field, *request.entity, model_field.model(), request.name)
                        : add_nodes(field, model_field.model(), request.name);
}

namespace {

/// Without what would end a name in Gmsh's files.
std::string view_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == '"'; }, '_');
  return name;
}

}  // namespace

void check_view_ending(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending != ".vtu" && ending != ".pos" && ending != ".msh") {
    throw Error("The size field cannot be written as " + path +
                ": choose the ending .vtu (ParaView), .pos or .msh (Gmsh).");
  }
}

std::size_t write_view(ModelField& model_field, const std::optional<Entity>& entity,
                       const std::string& path) {
  check_view_ending(path);
  const SizeField& field = model_field.field();
  check_entity(field, entity);
  std::size_t cell_count = 0;
  write_whole_file(path, [&](const std::string& unfinished) {
    std::ofstream file(unfinished, std::ios::binary);
    if (!file) {
      return false;
    }
    model_field.refresh_if_needed();
    check_some_size(field, entity);
    const std::string ending = ending_of(path);
    const std::string name = view_name(fs::path(path).stem().string());
    const FieldCells cells =
        field_cells(field, entity, ending == ".vtu" ? CellUse::show : CellUse::interpolate);
    cell_count = cells.cells.size();
    errno = 0;
    if (ending == ".vtu") {
      write_vtu(cells, file);
    } else if (ending == ".pos") {
      write_pos(cells, name, file);
    } else {
      write_msh(cells, name, file);
    }
    file.close();
    return !file.fail();
  });
  return cell_count;
}

}  // namespace meshgrow
