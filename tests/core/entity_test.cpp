#include "entity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace meshgrow {
namespace {

TEST(Entity, NamesOfDimensions) {
  EXPECT_EQ(dimension_name(0), "Point");
  EXPECT_EQ(dimension_name(1), "Curve");
  EXPECT_EQ(dimension_name(2), "Surface");
  EXPECT_EQ(dimension_name(3), "Volume");
  EXPECT_EQ(dimension_name(7), "Entity of dimension 7");
  EXPECT_EQ(dimension_name(-1), "Entity of dimension -1");
}

TEST(Entity, NameHasDimensionAndTag) {
  EXPECT_EQ(entity_name({2, 7}), "Surface 7");
  EXPECT_EQ(entity_name({3, -1}), "Volume -1");
}

TEST(Entity, ManyNamesAreCutShort) {
  std::vector<Entity> entities = {{2, 7}};
  EXPECT_EQ(entity_names({}), "");
  EXPECT_EQ(entity_names(entities), "Surface 7");
  entities.push_back({2, 9});
  EXPECT_EQ(entity_names(entities), "Surface 7 and Surface 9");
  entities.push_back({1, 3});
  EXPECT_EQ(entity_names(entities), "Surface 7, Surface 9 and Curve 3");
  EXPECT_EQ(entity_names(entities, 2), "Surface 7, Surface 9 and 1 more");
  for (int tag = 10; tag < 21; ++tag) {
    entities.push_back({0, tag});
  }
  EXPECT_EQ(entity_names(entities, 2), "Surface 7, Surface 9 and 12 more");
  EXPECT_EQ(entity_names(entities), "Surface 7, Surface 9, Curve 3, Point 10, Point 11 and 9 more");
}

TEST(Entity, IsOrderedByDimensionThenTag) {
  std::vector<Entity> entities = {{3, 1}, {1, 9}, {2, 5}, {1, 2}, {0, 100}};
  std::sort(entities.begin(), entities.end());
  EXPECT_EQ(entities, (std::vector<Entity>{{0, 100}, {1, 2}, {1, 9}, {2, 5}, {3, 1}}));
  EXPECT_TRUE((Entity{1, 2} != Entity{2, 1}));
  EXPECT_TRUE((Entity{1, 2} != Entity{1, 1}));
  EXPECT_FALSE((Entity{1, 2} != Entity{1, 2}));
}

}  // namespace
}  // namespace meshgrow
