#include "binary_stream.h"
#include "field_files.h"

namespace meshgrow {

namespace {

constexpr std::uint8_t vtk_hexahedron = 12;

/// Arrays appended to the XML: each tells there where it begins.
class AppendedArrays {
 public:
  explicit AppendedArrays(std::ostream& file) : file_(file) {}

  void declare(const char* type, const char* name, std::size_t bytes, int components = 1) {
    file_ << "        <DataArray type=\"" << type << "\" Name=\"" << name << '"';
    if (components > 1) {
      file_ << " NumberOfComponents=\"" << components << '"';
    }
    file_ << " format=\"appended\" offset=\"" << offset_ << "\"/>\n";
    offset_ += sizeof(std::uint64_t) + bytes;
  }

  void begin(std::size_t bytes) { write_binary(file_, static_cast<std::uint64_t>(bytes)); }

 private:
  std::ostream& file_;
  std::size_t offset_ = 0;
};

}  // namespace

void write_vtu(const FieldCells& cells, std::ostream& file) {
  const SharedNodes nodes = shared_nodes(cells);
  const std::size_t node_count = nodes.places.size();
  const std::size_t cell_count = cells.cells.size();
  AppendedArrays arrays(file);
  file << "<?xml version=\"1.0\"?>\n"
       << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
       << (is_little_endian ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n"
       << "  <UnstructuredGrid>\n"
       << "    <Piece NumberOfPoints=\"" << node_count << "\" NumberOfCells=\"" << cell_count
       << "\">\n      <PointData Scalars=\"size\">\n";
  arrays.declare("Float32", "size", 4 * node_count);
  file << "      </PointData>\n      <CellData>\n";
  arrays.declare("UInt8", "depth", cell_count);
  arrays.declare("UInt8", "exact", cell_count);
  arrays.declare("Int32", "group", 4 * cell_count);
  file << "      </CellData>\n      <Points>\n";
  arrays.declare("Float64", "Points", 24 * node_count, 3);
  file << "      </Points>\n      <Cells>\n";
  arrays.declare("Int64", "connectivity", 64 * cell_count);
  arrays.declare("Int64", "offsets", 8 * cell_count);
  arrays.declare("UInt8", "types", cell_count);
  file << "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n"
       << "  <AppendedData encoding=\"raw\">\n_";

  arrays.begin(4 * node_count);
  for (const float size : nodes.sizes) {
    write_binary(file, size);
  }
  arrays.begin(cell_count);
  for (const FieldCell& cell : cells.cells) {
    write_binary(file, cell.depth);
  }
  arrays.begin(cell_count);
  for (const FieldCell& cell : cells.cells) {
    write_binary(file, static_cast<std::uint8_t>(cell.exact ? 1 : 0));
  }
  arrays.begin(4 * cell_count);
  for (const FieldCell& cell : cells.cells) {
    write_binary(file, static_cast<std::int32_t>(cell.group + 1));
  }
  arrays.begin(24 * node_count);
  for (const LatticePlace& place : nodes.places) {
    const Vec3 p = cells.cube.at(place);
    file.write(reinterpret_cast<const char*>(p.data()), 24);
  }
  arrays.begin(64 * cell_count);
  for (const auto& of_cell : nodes.of_cell) {
    for (const std::uint32_t node : of_cell) {
      write_binary(file, static_cast<std::int64_t>(node));
    }
  }
  arrays.begin(8 * cell_count);
  for (std::size_t i = 1; i <= cell_count; ++i) {
    write_binary(file, static_cast<std::int64_t>(8 * i));
  }
  arrays.begin(cell_count);
  for (std::size_t i = 0; i < cell_count; ++i) {
    write_binary(file, vtk_hexahedron);
  }
  file << "\n  </AppendedData>\n</VTKFile>\n";
}

}  // namespace meshgrow
