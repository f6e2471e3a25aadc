#include "asker_processor.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

namespace meshgrow::cli {

#ifdef __linux__

namespace {

/// Looking costs as much as some turns.
constexpr unsigned turns_between_looks = 256;

/// What the system tells of a process.
struct Process {
  std::string name;
  int parent = 0;
  int processor = -1;  ///< that it ran on last
};

/// Without a name if nothing is told.
Process look_at(int id) {
  Process process;
  const std::string path = "/proc/" + std::to_string(id) + "/stat";
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return process;
  }
  char text[1024];
  const ssize_t count = ::read(file, text, sizeof text - 1);
  ::close(file);
  text[count < 0 ? 0 : count] = '\0';
  // The second field is the name, in parentheses; then there is one blank a field.
  const char* name = std::strchr(text, '(');
  const char* at = std::strrchr(text, ')');
  if (name == nullptr || at == nullptr) {
    return process;
  }
  process.name.assign(name + 1, at);
  constexpr int field_of_parent = 4;
  constexpr int field_of_processor = 39;
  for (int field = 3; field <= field_of_processor; ++field) {
    at = std::strchr(at + 1, ' ');
    if (at == nullptr) {
      break;
    }
    if (field == field_of_parent) {
      process.parent = std::atoi(at + 1);
    } else if (field == field_of_processor) {
      process.processor = std::atoi(at + 1);
    }
  }
  return process;
}

/// Gmsh starts programs by a shell, which may wait for their end.
bool is_shell(const std::string& name) { return name == "sh" || name == "dash" || name == "bash"; }

}  // namespace

AskerProcessor::AskerProcessor() : asker_(::getppid()) {
  const Process parent = look_at(asker_);
  if (is_shell(parent.name)) {
    asker_ = parent.parent;
  }
}

void AskerProcessor::follow() {
  if (turns_++ % turns_between_looks != 0) {
    return;
  }
  const int now = look_at(asker_).processor;
  if (now >= 0 && now != processor_ && now < CPU_SETSIZE) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(now, &only);
    if (::sched_setaffinity(0, sizeof only, &only) == 0) {
      processor_ = now;
    }
  }
}

#else

AskerProcessor::AskerProcessor() = default;
void AskerProcessor::follow() {}

#endif

}  // namespace meshgrow::cli
