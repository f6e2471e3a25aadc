// Saved fields with sound checksums that say what no field can: an Error when it is touched, and
// nothing worse.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>

#include "error.h"
#include "field_file.h"
#include "mended_field.h"
#include "random_facets.h"
#include "sphere_field.h"
#include "test_with_folder.h"

namespace meshgrow {
namespace {

namespace fs = std::filesystem;

const Entity volume = {3, 1};

/// A saved field, in a folder of its own, whose bytes can be changed where they stand.
class CraftedField : public test::TestWithFolder {
 protected:
  std::string path() const { return TestWithFolder::path("field.mgf"); }

  void save(const SizeField& field) {
    save_field(field, path());
    bytes_ = test::bytes_of(path());
    group_ = field.parts().groups[0];
  }

  const StoredTree& tree() const { return group_.tree->stored(); }
  const StoredGrid& grid() const { return group_.grid->stored(); }

  /// Puts another value in the place of an element.
  template <typename T>
  void change(const StoredArray<T>& array, std::size_t index, const T& value) {
    const std::string old(reinterpret_cast<const char*>(array.begin()), array.bytes());
    if (places_.count(array.data()) == 0) {
      places_[array.data()] = bytes_.find(old);
    }
    const std::size_t place = places_[array.data()];
    ASSERT_NE(place, std::string::npos);
    std::memcpy(&bytes_[place + index * sizeof(T)], &value, sizeof(T));
  }

  /// The same for bytes in the directory, of which it has some.
  void change(const std::string& old, const std::string& value) {
    std::size_t directory = 0;
    std::memcpy(&directory, &bytes_[24], sizeof(directory));
    const std::size_t place = bytes_.find(old, directory);
    ASSERT_NE(place, std::string::npos);
    ASSERT_EQ(old.size(), value.size());
    bytes_.replace(place, old.size(), value);
  }

  static std::string bytes_of(double value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
  }

  void write() {
    fuzz::mend_field(reinterpret_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
    std::ofstream(path(), std::ios::binary) << bytes_;
  }

  /// What is said when the crafted field is loaded and asked for sizes; "" if nothing.
  std::string sentence() {
    write();
    try {
      const SizeField field = load_field(path());
      test::Random random(1);
      for (int i = 0; i < 2000; ++i) {
        const Vec3 p = test::random_in_ball(random, i % 2 == 0 ? 2.0 : 1.1);
        field.size(volume, p);
        field.exact_size(volume, p);
        field.smallest_sizes(&p, 1, std::array<double, 1>().data());
      }
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  std::string bytes_;
  SizeField::Part group_;
  std::map<const void*, std::size_t> places_;
};

TEST_F(CraftedField, IsReadWhereNothingWasChanged) {
  save(test::sphere_field(500));
  EXPECT_EQ(sentence(), "");
}

TEST_F(CraftedField, NodesThatAreNot) {
  save(test::sphere_field(500));
  simd::WideNode node = tree().nodes[0];
  std::fill(node.child, node.child + simd::lanes, 0x00FFFFFFu);
  change(tree().nodes, 0, node);
  EXPECT_NE(sentence().find("nodes is damaged"), std::string::npos);
}

TEST_F(CraftedField, NodesOneBelowTheOther) {
  // More levels than a search has room for.
  save(test::sphere_field(5000));
  ASSERT_GT(tree().nodes.size(), 30u);
  for (std::uint32_t i = 0; i < 30; ++i) {
    simd::WideNode node = tree().nodes[i];
    node.child[0] = i + 1;
    change(tree().nodes, i, node);
  }
  EXPECT_NE(sentence().find("nodes is damaged"), std::string::npos);
}

TEST_F(CraftedField, FacetsBeyondTheLast) {
  save(test::sphere_field(500));
  const std::size_t last = tree().blocks.size() - 1;
  simd::FacetBlock block = tree().blocks[last];
  ASSERT_LT(block.count, 8u);
  block.start_size[7] = 1e-3f;
  change(tree().blocks, last, block);
  EXPECT_NE(sentence().find("blocks of facets is damaged"), std::string::npos);
}

TEST_F(CraftedField, CellsDividedWithoutEnd) {
  save(test::sphere_field(2000));
  ASSERT_GT(grid().blocks.size(), 40u);
  for (std::size_t i = 1; i < 40; ++i) {
    GridBlock block;
    block.fill(grid_node(GridNodeKind::block, i + 1));
    change(grid().blocks, i, block);
  }
  for (std::size_t i = 0; i < grid().table.size(); ++i) {
    change(grid().table, i, GridTable::Entry{grid_node(GridNodeKind::block, 1), 0});
  }
  EXPECT_NE(sentence().find("divided without end"), std::string::npos);
  const SizeField loaded = load_field(path());
  EXPECT_THROW(loaded.parts().groups[0].grid->for_each_leaf([](const GridLeaf&) {}), Error);
}

TEST_F(CraftedField, CellsReachedTwice) {
  // Few levels, but leaves beyond number.
  save(test::sphere_field(2000));
  ASSERT_GT(grid().blocks.size(), 40u);
  for (std::size_t i = 1; i < 19; ++i) {
    GridBlock block;
    block.fill(i < 18 ? grid_node(GridNodeKind::block, i + 1) : grid_node(GridNodeKind::tree, 0));
    change(grid().blocks, i, block);
  }
  write();
  const SizeField loaded = load_field(path());
  EXPECT_THROW(loaded.parts().groups[0].grid->for_each_leaf([](const GridLeaf&) {}), Error);
}

TEST_F(CraftedField, NumbersThatAreNone) {
  for (const double none :
       {std::numeric_limits<double>::quiet_NaN(), -1.0, std::numeric_limits<double>::infinity()}) {
    save(test::sphere_field(500));
    change(bytes_of(grid().cube.edge), bytes_of(none));
    EXPECT_NE(sentence().find("is damaged"), std::string::npos) << none;
  }
}

TEST_F(CraftedField, AShortLineForManyEntities) {
  Topology topology;
  topology.add_entity(volume, {}, Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  for (int tag = 1; tag <= 200; ++tag) {
    topology.add_entity({2, tag}, {}, Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  }
  SizeField field(topology);
  SizeFunction function;
  function.sources = {{2, 1}};
  function.attachments = {volume};
  function.size_limit = 1.0;
  field.add(function);
  field.build_trees();
  save(field);
  ASSERT_EQ(sentence(), "");
  change("source Surface{1}", "source Surface{:}");
  EXPECT_NE(sentence().find("is damaged"), std::string::npos);
}

TEST_F(CraftedField, AnEmptyFileIsNone) {
  std::ofstream(path(), std::ios::binary).flush();
  EXPECT_THROW(load_field(path()), Error);
}

}  // namespace
}  // namespace meshgrow
