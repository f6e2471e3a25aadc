#include "unfinished_file.h"

#include "error.h"
#include "interruption.h"
#include "whole_file.h"

namespace meshgrow::cli {

UnfinishedFile::UnfinishedFile(const std::filesystem::path& place, const std::string& ending)
    : place_(place_of_file(place.string())), path_(place_) {
  path_.replace_filename("." + place_.stem().string() + ".unfinished" + ending);
  remove_when_interrupted(path_.string());
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code failed;
  std::filesystem::remove(path_, failed);
  remove_when_interrupted("");
}

void UnfinishedFile::finish() {
  std::error_code failed;
  std::filesystem::rename(path_, place_, failed);
  if (failed) {
    throw Error("Cannot write " + place_.string() + " (" + failed.message() +
                "): choose another place.");
  }
}

}  // namespace meshgrow::cli
