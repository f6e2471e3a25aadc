// The public C++ interface in a program that is linked to the static core, which has classes of the
// same names: each part of the program gets its own.

#include <gtest/gtest.h>

#include "meshgrow.hpp"

namespace {

TEST(PublicNames, AreNotThoseOfTheCore) {
  try {
    meshgrow::SizeField field;
    FAIL() << "a field without Gmsh";
  } catch (const meshgrow::Error& error) {
    EXPECT_NE(std::string(error.what()).find("initialize"), std::string::npos) << error.what();
  }
}

}  // namespace
