#include "unfinished_file.h"

#include "interruption.h"

namespace meshgrow::cli {

UnfinishedFile::UnfinishedFile(std::filesystem::path place, const std::string& ending)
    : place_(std::move(place)), path_(place_) {
  path_.replace_filename("." + place_.stem().string() + ".unfinished" + ending);
  remove_when_interrupted(path_.string());
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code failed;
  std::filesystem::remove(path_, failed);
  remove_when_interrupted("");
}

void UnfinishedFile::finish() { std::filesystem::rename(path_, place_); }

}  // namespace meshgrow::cli
