#include "field_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "byte_stream.h"
#include "error.h"
#include "field_layout.h"
#include "number_text.h"
#include "size_function_text.h"
#include "tree_shape.h"

namespace meshgrow {

namespace {

using field_layout::Header;

/// Says whether elements `first` to before `end` of an array are possible.
template <typename T, typename IsSound>
auto each_of(const T* data, IsSound is_sound) {
  return [data, is_sound](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      if (!is_sound(i, data[i])) {
        return false;
      }
    }
    return true;
  };
}

bool is_slope(double slope) { return slope >= 0.0 && slope < 1.0; }

std::size_t node_count_for(std::size_t blocks) {
  return blocks == 0 ? 0 : nodes_for(static_cast<std::uint32_t>(blocks));
}

class Reader {
 public:
  Reader(const std::string& path, std::shared_ptr<const MappedFile> file, const Header& header)
      : path_(path),
        file_(std::move(file)),
        directory_(file_->data() + header.directory_begin, header.directory_bytes,
                   path + " is damaged: save the field again.") {}

  SizeField::Parts field() {
    SizeField::Parts result;
    directory_.text();  // who wrote it is for people
    result.tolerance = directory_.number<double>();
    result.topology = topology();
    const std::size_t functions = directory_.count_of(25);
    for (std::size_t i = 0; i < functions; ++i) {
      const std::string name = directory_.text();
      const std::string line = directory_.text();
      result.functions.push_back(parse_size_function(line, result.topology));
      SizeFunction& function = result.functions.back();
      // A file names entities one by one: short lines do not stand for many.
      directory_.require(function.sources.size() + function.attachments.size() <= line.size());
      function.name = name;
      result.effective.push_back(directory_.number<std::uint8_t>() != 0);
      result.facet_counts.push_back(directory_.count());
    }
    const std::size_t groups = directory_.count_of(1);
    for (std::size_t i = 0; i < groups; ++i) {
      result.groups.push_back(group(i, functions));
      for (const Entity& entity : result.groups.back().entities) {
        directory_.require(result.topology.contains(entity));
      }
    }
    return result;
  }

 private:
  Vec3 vector() {
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      result[axis] = directory_.number<double>();
    }
    return result;
  }

  Box box() {
    const Vec3 min = vector();
    return Box(min, vector());
  }

  Entity entity() {
    const int dim = directory_.number<std::int32_t>();
    directory_.require(dim >= 0 && dim <= 3);
    return {dim, directory_.number<std::int32_t>()};
  }

  std::vector<Entity> entities() {
    std::vector<Entity> result(directory_.count_of(8));
    for (Entity& one : result) {
      one = entity();
    }
    return result;
  }

  Topology topology() {
    Topology result;
    const std::size_t count = directory_.count_of(64);
    for (std::size_t i = 0; i < count; ++i) {
      const Entity one = entity();
      std::vector<Entity> lower = entities();
      result.add_entity(one, std::move(lower), box());
    }
    for (const Entity& one : result.entities()) {
      for (const Entity& below : result.lower(one)) {
        directory_.require(result.contains(below));
      }
    }
    const std::size_t groups = directory_.count_of(24);
    for (std::size_t i = 0; i < groups; ++i) {
      const Entity one = entity();
      const std::string name = directory_.text();
      result.add_physical_group({one.dim, one.tag, name, entities()});
    }
    return result;
  }

  SizeField::Action action(std::size_t functions) {
    const std::size_t function = directory_.count();
    directory_.require(function < functions);
    return {function, directory_.number<std::uint8_t>() != 0};
  }

  std::vector<SizeField::Origin> origins(std::size_t functions) {
    std::vector<SizeField::Origin> result(directory_.count_of(24));
    for (SizeField::Origin& origin : result) {
      origin.first_facet = directory_.count();
      origin.function = directory_.count();
      directory_.require(origin.function < functions);
      const std::size_t stretches = directory_.count_of(16);
      for (std::size_t i = 0; i < stretches; ++i) {
        const std::size_t first = directory_.count();
        origin.entities.begin(first, entity());
      }
    }
    return result;
  }

  SizeField::Part group(std::size_t index, std::size_t functions) {
    SizeField::Part result;
    const std::size_t actions = directory_.count_of(9);
    for (std::size_t i = 0; i < actions; ++i) {
      result.actions.push_back(action(functions));
    }
    result.entities = entities();
    result.size_limit = directory_.number<double>();
    directory_.require(!result.entities.empty() && result.size_limit > 0.0);
    result.limit = action(functions);
    result.origins = origins(functions);
    where_ = path_ + ", group " + std::to_string(index + 1);
    result.tree = std::make_shared<FacetTree>(tree());
    directory_.require(result.tree->empty() ||
                       (!result.origins.empty() && result.origins.front().first_facet == 0));
    if (directory_.number<std::uint8_t>() != 0) {
      StoredGrid stored = grid(result.tree->stored().nodes.size());
      result.grid = std::make_shared<BackgroundGrid>(result.tree, std::move(stored));
    }
    return result;
  }

  StoredTree tree() {
    StoredTree result;
    result.box = box();
    result.centre = vector();
    result.unit = directory_.number<double>();
    result.largest_slope = directory_.number<double>();
    directory_.require(result.unit > 0.0 && is_slope(result.largest_slope));
    const ArrayPlace<SizedFacet> facets = place<SizedFacet>();
    const auto order = place<std::uint32_t>();
    const auto nodes = place<simd::WideNode>();
    const auto boxes = place<WideBoxes>();
    const auto slopes = place<float>();
    const auto blocks = place<simd::FacetBlock>();
    const auto entries = place<simd::NodeEntry>();
    const std::size_t facet_count = facets.count;
    const std::size_t node_count = nodes.count;
    const std::size_t block_count = blocks.count;
    directory_.require(order.count == facet_count && boxes.count == node_count &&
                       slopes.count == node_count && entries.count == block_count &&
                       facet_count <= 0xFFFFFFFFu - simd::lanes &&
                       block_count == (facet_count + simd::lanes - 1) / simd::lanes &&
                       node_count == node_count_for(block_count) && node_count <= simd::max_nodes);
    result.facets =
        array(facets, "facets", each_of(facets.data, [](std::size_t, const SizedFacet& facet) {
                return facet.facet.corner_count >= 1 && facet.facet.corner_count <= 3 &&
                       facet.start_size > 0.0 && is_slope(facet.slope);
              }));
    result.order = array(order, "order of facets",
                         each_of(order.data, [facet_count](std::size_t, std::uint32_t original) {
                           return original < facet_count;
                         }));
    result.nodes = array(
        nodes, "nodes",
        each_of(nodes.data, [block_count](std::size_t i, const simd::WideNode& node) {
          const NodeChildren children =
              children_of(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(block_count));
          for (int lane = 0; lane < simd::lanes; ++lane) {
            const bool is_child = lane < children.count;
            if ((node.start_size[lane] < FacetTree::infinity) != is_child ||
                (is_child && node.child[lane] != children.codes[static_cast<std::size_t>(lane)])) {
              return false;
            }
          }
          return true;
        }));
    result.boxes = array(boxes, "boxes", [](std::size_t, std::size_t) { return true; });
    result.slopes = array(slopes, "slopes", [](std::size_t, std::size_t) { return true; });
    result.blocks =
        array(blocks, "blocks of facets",
              each_of(blocks.data, [facet_count](std::size_t i, const simd::FacetBlock& block) {
                const std::size_t first = i * simd::lanes;
                const std::size_t count = std::min<std::size_t>(simd::lanes, facet_count - first);
                for (std::size_t lane = 0; lane < simd::lanes; ++lane) {
                  if ((block.start_size[lane] < FacetTree::infinity) != (lane < count)) {
                    return false;
                  }
                }
                return block.first == first && block.count == count;
              }));
    result.block_entries =
        array(entries, "entries of blocks",
              each_of(entries.data, [node_count](std::size_t, simd::NodeEntry entry) {
                return entry >> 8 < node_count;
              }));
    return result;
  }

  StoredGrid grid(std::size_t node_count) {
    StoredGrid result;
    result.size_limit = directory_.number<double>();
    result.cube.origin = vector();
    result.cube.edge = directory_.number<double>();
    directory_.require(result.size_limit > 0.0 && result.cube.origin.allFinite() &&
                       result.cube.edge >= 0.0 && std::isfinite(result.cube.edge));
    result.table_depth = static_cast<int>(directory_.number<std::uint32_t>());
    result.statistics.depth = static_cast<int>(directory_.number<std::uint32_t>());
    const auto blocks = place<GridBlock>();
    const auto corners = place<GridCorners>();
    const auto begins = place<std::uint32_t>();
    const auto entries = place<simd::NodeEntry>();
    const auto table = place<GridTable::Entry>();
    const std::size_t block_count = blocks.count;
    const std::size_t corner_count = corners.count;
    const std::size_t begin_count = begins.count;
    const std::size_t entry_count = entries.count;
    directory_.require(result.table_depth >= 0 && result.table_depth <= 5 && block_count > 0 &&
                       begin_count > 0 && table.count == std::size_t{1} << 3 * result.table_depth);
    const auto is_node = [=](GridNodeCode code, std::size_t parent) {
      switch (kind_of(code)) {
        case GridNodeKind::block:
          return index_of(code) > parent && index_of(code) < block_count;
        case GridNodeKind::interpolated:
          return index_of(code) < corner_count;
        case GridNodeKind::exact:
          return index_of(code) + 1 < begin_count;
        default:
          return true;
      }
    };
    result.blocks = array(blocks, "blocks of the grid",
                          each_of(blocks.data, [is_node](std::size_t i, const GridBlock& block) {
                            for (std::size_t child = 0; child < (i == 0 ? 1 : 8); ++child) {
                              if (!is_node(block[child], i)) {
                                return false;
                              }
                            }
                            return true;
                          }));
    result.corners = array(corners, "corners of cells",
                           each_of(corners.data, [](std::size_t, const GridCorners& values) {
                             return std::all_of(values.begin(), values.end(),
                                                [](float value) { return value > 0.0f; });
                           }));
    result.exact_begin = array(begins, "begins of exact cells",
                               each_of(begins.data, [first = begins.data, entry_count](
                                                        std::size_t i, std::uint32_t begin) {
                                 return begin <= entry_count && (i == 0 || first[i - 1] <= begin);
                               }));
    result.exact_entries =
        array(entries, "entries of exact cells",
              each_of(entries.data, [node_count](std::size_t, simd::NodeEntry entry) {
                return entry >> 8 < node_count;
              }));
    result.table = array(table, "table of the grid",
                         each_of(table.data, [is_node, depth = result.table_depth](
                                                 std::size_t, const GridTable::Entry& entry) {
                           return is_node(entry.node, 0) && static_cast<int>(entry.depth) <= depth;
                         }));
    result.statistics.interpolated_leaves = corner_count;
    result.statistics.exact_leaves = begin_count - 1;
    result.statistics.blocks = block_count - 1;
    result.statistics.bytes = result.blocks.bytes() + result.corners.bytes() +
                              result.exact_begin.bytes() + result.exact_entries.bytes() +
                              result.table.bytes();
    return result;
  }

  template <typename T>
  struct ArrayPlace {
    const T* data;
    std::size_t count;
    std::vector<std::uint64_t> checksums;
  };

  template <typename T>
  ArrayPlace<T> place() {
    const std::size_t begin = directory_.count();
    const std::size_t count = directory_.count();
    const bool is_as_here = directory_.number<std::uint32_t>() == sizeof(T) &&
                            directory_.number<std::uint32_t>() == block_shift(sizeof(T));
    directory_.require(is_as_here && begin % field_layout::alignment == 0 &&
                       begin <= file_->size() && count <= (file_->size() - begin) / sizeof(T));
    const std::size_t per_block = std::size_t{1} << block_shift(sizeof(T));
    std::vector<std::uint64_t> checksums((count + per_block - 1) / per_block);
    for (std::uint64_t& one : checksums) {
      one = directory_.number<std::uint64_t>();
    }
    return {reinterpret_cast<const T*>(file_->data() + begin), count, std::move(checksums)};
  }

  template <typename T>
  StoredArray<T> array(const ArrayPlace<T>& place, const std::string& name,
                       std::function<bool(std::size_t, std::size_t)> is_sound) {
    CheckedBlocks::Array of = {reinterpret_cast<const char*>(place.data), place.count, sizeof(T),
                               where_ + ": the array of " + name};
    // The blocks keep the file, and the array the blocks.
    const auto keeps_file = [file = file_, is_sound = std::move(is_sound)](std::size_t first,
                                                                           std::size_t end) {
      return is_sound(first, end);
    };
    return {place.data, place.count,
            std::make_shared<CheckedBlocks>(std::move(of), place.checksums, keeps_file)};
  }

  std::string path_;
  std::string where_;
  std::shared_ptr<const MappedFile> file_;
  ByteReader directory_;
};

Header read_header(const std::string& path, const MappedFile& file) {
  Header header = {};
  if (file.size() > 0) {
    std::memcpy(&header, file.data(), std::min(file.size(), sizeof(header)));
  }
  if (file.size() < field_layout::magic.size() || header.magic != field_layout::magic) {
    throw Error(path + " is no size field of meshgrow: give a .mgf file that meshgrow saved.");
  }
  if (file.size() < sizeof(header)) {
    throw Error(path + " is truncated: copy it again, or save the field again.");
  }
  if (header.version != field_layout::format_version) {
    throw Error(path + " has version " + std::to_string(header.version) +
                " of the format, and this meshgrow reads version " +
                std::to_string(field_layout::format_version) + ": save the field again.");
  }
  if (header.checksum != checksum(&header, offsetof(Header, checksum))) {
    throw Error(path + " is damaged in its header: save the field again.");
  }
  if (header.file_bytes != file.size()) {
    throw Error(path + (file.size() < header.file_bytes ? " is truncated (" : " is too long (") +
                grouped_digits(file.size()) + " of " + grouped_digits(header.file_bytes) +
                " bytes): copy it again, or save the field again.");
  }
  if (header.directory_begin > file.size() ||
      header.directory_bytes != file.size() - header.directory_begin ||
      header.directory_checksum !=
          checksum(file.data() + header.directory_begin, header.directory_bytes)) {
    throw Error(path + " is damaged in its directory: save the field again.");
  }
  return header;
}

}  // namespace

SizeField::Parts read_field(const std::string& path, std::shared_ptr<const MappedFile> file) {
  const Header header = read_header(path, *file);
  return Reader(path, std::move(file), header).field();
}

}  // namespace meshgrow
