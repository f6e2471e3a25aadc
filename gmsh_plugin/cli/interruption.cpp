#include "interruption.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace meshgrow::cli {

namespace {

/// Only what may be touched in a signal handler: plain memory and atomics.
std::array<char, 4096> path_to_remove{};
std::atomic<bool> has_path{false};
std::atomic<const char*> goal{"mesh"};
std::atomic<bool> goal_is_written{false};

void tell(const char* text) {
  // There is no one to tell if standard error is gone.
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) {
    return;
  }
}

void end_at_once(int signal) {
  if (has_path) {
    unlink(path_to_remove.data());
  }
  tell(isatty(STDERR_FILENO) != 0 ? "\nmeshgrow: " : "meshgrow: ");
  tell(goal_is_written ? "Interrupted after the " : "Interrupted: no ");
  tell(goal);
  tell(" was written.\n");
  _exit(128 + signal);
}

}  // namespace

void end_when_interrupted(const char* what_is_written) {
  goal = what_is_written;
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    struct sigaction action {};
    action.sa_handler = end_at_once;
    sigemptyset(&action.sa_mask);
    // The first signal decides: neither interrupts the other's work.
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
      sigaction(signal, &action, nullptr);
    }
  }
}

void remove_when_interrupted(const std::string& path) {
  has_path = false;
  if (!path.empty() && path.size() < path_to_remove.size()) {
    std::memcpy(path_to_remove.data(), path.c_str(), path.size() + 1);
    has_path = true;
  }
}

void tell_that_it_is_written() { goal_is_written = true; }

}  // namespace meshgrow::cli
