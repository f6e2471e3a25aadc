#include "binary_stream.h"
#include "field_files.h"

namespace meshgrow {

namespace {

constexpr int volume_tag = 1;
constexpr int hexahedron_type = 5;

void write_count(std::ostream& file, std::size_t count) {
  write_binary(file, static_cast<std::uint64_t>(count));
}

void write_volume(const FieldCells& cells, std::ostream& file) {
  file << "$Entities\n";
  for (const std::size_t entities : {0, 0, 0, 1}) {
    write_count(file, entities);
  }
  write_binary(file, volume_tag);
  for (const Vec3& corner :
       {cells.cube.origin,
        cells.cube.at({1u << max_grid_depth, 1u << max_grid_depth, 1u << max_grid_depth})}) {
    for (const double coordinate : {corner.x(), corner.y(), corner.z()}) {
      write_binary(file, coordinate);
    }
  }
  write_count(file, 0);  // physical groups
  write_count(file, 0);  // surfaces
  file << "\n$EndEntities\n";
}

void write_nodes(const FieldCells& cells, const SharedNodes& nodes, std::ostream& file) {
  const std::size_t count = nodes.places.size();
  file << "$Nodes\n";
  for (const std::size_t number : {std::size_t{1}, count, std::size_t{1}, count}) {
    write_count(file, number);  // blocks, nodes, smallest and largest tag
  }
  for (const int number : {3, volume_tag, 0}) {
    write_binary(file, number);  // dimension, tag, without parameters
  }
  write_count(file, count);
  for (std::size_t i = 1; i <= count; ++i) {
    write_count(file, i);
  }
  for (const LatticePlace& place : nodes.places) {
    const Vec3 p = cells.cube.at(place);
    file.write(reinterpret_cast<const char*>(p.data()), 24);
  }
  file << "\n$EndNodes\n";
}

void write_elements(const SharedNodes& nodes, std::ostream& file) {
  const std::size_t count = nodes.of_cell.size();
  file << "$Elements\n";
  for (const std::size_t number : {std::size_t{1}, count, std::size_t{1}, count}) {
    write_count(file, number);
  }
  for (const int number : {3, volume_tag, hexahedron_type}) {
    write_binary(file, number);
  }
  write_count(file, count);
  for (std::size_t i = 0; i < count; ++i) {
    write_count(file, i + 1);
    for (const std::uint32_t node : nodes.of_cell[i]) {
      write_count(file, node + std::size_t{1});
    }
  }
  file << "\n$EndElements\n";
}

void write_sizes(const FieldCells& cells, const std::string& name, std::ostream& file) {
  // One text, the name; one real number, the time; step, components and elements.
  file << "$ElementNodeData\n1\n\"" << name << "\"\n1\n0\n3\n0\n1\n" << cells.cells.size() << '\n';
  for (std::size_t i = 0; i < cells.cells.size(); ++i) {
    write_binary(file, static_cast<int>(i + 1));
    write_binary(file, 8);
    for (const int corner : hexahedron_corners) {
      write_binary(file, static_cast<double>(cells.cells[i].sizes[corner]));
    }
  }
  file << "\n$EndElementNodeData\n";
}

}  // namespace

void write_msh(const FieldCells& cells, const std::string& name, std::ostream& file) {
  const SharedNodes nodes = shared_nodes(cells);
  file << "$MeshFormat\n4.1 1 " << sizeof(std::uint64_t) << '\n';
  write_binary(file, 1);  // tells the byte order
  file << "\n$EndMeshFormat\n";
  write_volume(cells, file);
  write_nodes(cells, nodes, file);
  write_elements(nodes, file);
  write_sizes(cells, name, file);
}

}  // namespace meshgrow
