#include "field_writer.h"

#include <cstring>
#include <fstream>
#include <vector>

#include "byte_stream.h"
#include "field_layout.h"
#include "size_function_text.h"

namespace meshgrow {

namespace {

using field_layout::Header;

class Writer {
 public:
  explicit Writer(const std::string& path) : file_(path, std::ios::binary | std::ios::trunc) {
    const Header empty = {};
    write(&empty, sizeof(empty));
  }

  bool is_open() const { return file_.is_open(); }

  void field(const SizeField::Parts& field) {
    directory_.text(MESHGROW_VERSION);
    directory_.number(field.tolerance);
    topology(field.topology);
    directory_.count(field.functions.size());
    for (std::size_t i = 0; i < field.functions.size(); ++i) {
      directory_.text(field.functions[i].name);
      directory_.text(size_function_text(field.functions[i]));
      directory_.number<std::uint8_t>(field.effective[i] ? 1 : 0);
      directory_.count(field.facet_counts[i]);
    }
    directory_.count(field.groups.size());
    for (const SizeField::Part& part : field.groups) {
      group(part);
    }
  }

  /// False if something could not be written.
  bool finish() {
    pad();
    Header header = {field_layout::magic,
                     field_layout::format_version,
                     0,
                     0,
                     position_,
                     directory_.bytes().size(),
                     0,
                     0,
                     0};
    header.directory_checksum = checksum(directory_.bytes().data(), directory_.bytes().size());
    write(directory_.bytes().data(), directory_.bytes().size());
    header.file_bytes = position_;
    header.checksum = checksum(&header, offsetof(Header, checksum));
    file_.seekp(0);
    file_.write(reinterpret_cast<const char*>(&header), sizeof(header));
    file_.close();
    return !file_.fail();
  }

 private:
  void write(const void* bytes, std::size_t count) {
    file_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    position_ += count;
  }

  void pad() {
    constexpr std::array<char, field_layout::alignment> zeros = {};
    write(zeros.data(), (zeros.size() - position_ % zeros.size()) % zeros.size());
  }

  void vector(const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) {
      directory_.number(v[axis]);
    }
  }

  void entity(const Entity& entity) {
    directory_.number<std::int32_t>(entity.dim);
    directory_.number<std::int32_t>(entity.tag);
  }

  void entities(const std::vector<Entity>& entities) {
    directory_.count(entities.size());
    for (const Entity& one : entities) {
      entity(one);
    }
  }

  void box(const Box& box) {
    vector(box.min());
    vector(box.max());
  }

  void topology(const Topology& topology) {
    const std::vector<Entity> all = topology.entities();
    directory_.count(all.size());
    for (const Entity& one : all) {
      entity(one);
      entities(topology.lower(one));
      box(topology.box(one));
    }
    directory_.count(topology.physical_groups().size());
    for (const PhysicalGroup& group : topology.physical_groups()) {
      entity({group.dim, group.tag});
      directory_.text(group.name);
      entities(group.entities);
    }
  }

  void action(const SizeField::Action& action) {
    directory_.count(action.function);
    directory_.number<std::uint8_t>(action.inside_source ? 1 : 0);
  }

  void group(const SizeField::Part& part) {
    directory_.count(part.actions.size());
    for (const SizeField::Action& one : part.actions) {
      action(one);
    }
    entities(part.entities);
    directory_.number(part.size_limit);
    action(part.limit);
    directory_.count(part.origins.size());
    for (const SizeField::Origin& origin : part.origins) {
      directory_.count(origin.first_facet);
      directory_.count(origin.function);
      directory_.count(origin.entities.stretches().size());
      for (const auto& [first, source] : origin.entities.stretches()) {
        directory_.count(first);
        entity(source);
      }
    }
    const StoredTree& tree = part.tree->stored();
    box(tree.box);
    vector(tree.centre);
    directory_.number(tree.unit);
    directory_.number(tree.largest_slope);
    array(tree.facets);
    array(tree.order);
    array(tree.nodes);
    array(tree.boxes);
    array(tree.slopes);
    array(tree.blocks);
    array(tree.block_entries);
    directory_.number<std::uint8_t>(part.grid ? 1 : 0);
    if (part.grid) {
      grid(part.grid->stored());
    }
  }

  void grid(const StoredGrid& grid) {
    directory_.number(grid.size_limit);
    vector(grid.cube.origin);
    directory_.number(grid.cube.edge);
    directory_.number(static_cast<std::uint32_t>(grid.table_depth));
    directory_.number(static_cast<std::uint32_t>(grid.statistics.depth));
    array(grid.blocks);
    array(grid.corners);
    array(grid.exact_begin);
    array(grid.exact_entries);
    array(grid.table);
  }

  void begin_array(std::size_t count, std::size_t element_bytes) {
    pad();
    directory_.count(position_);
    directory_.count(count);
    directory_.number(static_cast<std::uint32_t>(element_bytes));
    directory_.number(static_cast<std::uint32_t>(block_shift(element_bytes)));
  }

  void block(const void* bytes, std::size_t count) {
    directory_.number(checksum(bytes, count));
    write(bytes, count);
  }

  /// `to_bytes(elements, count)` gives what to write for them.
  template <typename T, typename ToBytes>
  void array(const StoredArray<T>& array, ToBytes to_bytes) {
    begin_array(array.size(), sizeof(T));
    const std::size_t per_block = std::size_t{1} << block_shift(sizeof(T));
    for (std::size_t first = 0; first < array.size(); first += per_block) {
      const std::size_t count = std::min(per_block, array.size() - first);
      block(to_bytes(array.range(first, first + count), count), count * sizeof(T));
    }
  }

  template <typename T>
  void array(const StoredArray<T>& values) {
    array(values, [](const T* elements, std::size_t) -> const void* { return elements; });
  }

  /// In memory there are bytes between the members that say nothing.
  void array(const StoredArray<SizedFacet>& facets) {
    std::vector<char> bytes;
    array(facets, [&bytes](const SizedFacet* elements, std::size_t count) -> const void* {
      bytes.assign(count * sizeof(SizedFacet), '\0');
      for (std::size_t i = 0; i < count; ++i) {
        char* to = bytes.data() + i * sizeof(SizedFacet);
        const SizedFacet& from = elements[i];
        std::memcpy(to, from.facet.corners.data(), 72);
        std::memcpy(to + 72, &from.facet.corner_count, 4);
        std::memcpy(to + 80, &from.start_size, 8);
        std::memcpy(to + 88, &from.slope, 8);
      }
      return bytes.data();
    });
  }

  std::ofstream file_;
  std::uint64_t position_ = 0;
  ByteWriter directory_;
};

}  // namespace

bool write_field(const SizeField::Parts& field, const std::string& path) {
  Writer writer(path);
  if (!writer.is_open()) {
    return false;
  }
  writer.field(field);
  return writer.finish();
}

}  // namespace meshgrow
