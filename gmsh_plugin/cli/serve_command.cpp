#include "serve_command.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include "c_guard.h"
#include "entity_text.h"
#include "error.h"
#include "opened_field.h"
#include "size_server.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

struct ServeArguments {
  std::string file;    ///< .mgf, or what Gmsh can open
  std::string entity;  ///< "3,2": this entity's sizes; empty: the smallest of all groups
  FieldArguments field;
};

/// Standard output for answers alone: what this process prints goes to standard error.
class AnswerStream {
 public:
  AnswerStream() : descriptor_(::dup(STDOUT_FILENO)) {
    if (descriptor_ < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
      throw Error(
          "There is no standard output to answer on: start this from Gmsh's field "
          "ExternalProcess.");
    }
  }
  ~AnswerStream() { ::close(descriptor_); }
  AnswerStream(const AnswerStream&) = delete;
  AnswerStream& operator=(const AnswerStream&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Needs no memory, as there may be none.
void tell(const char* sentence, const char* consequence = "") {
  std::cerr << "meshgrow: " << sentence << consequence << std::endl;
}

const char* sentence_of(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? c::out_of_memory : error.what();
}

void no_sizes(const Vec3* /*points*/, std::size_t count, double* sizes) {
  std::fill(sizes, sizes + count, SizeField::no_size);
}

SizesAt sizes_of(const SizeField& field, const std::string& entity_text) {
  if (entity_text.empty()) {
    return [&field](const Vec3* points, std::size_t count, double* sizes) {
      field.smallest_sizes(points, count, sizes);
    };
  }
  const Entity entity = read_entity(entity_text, field.topology());
  if (!field.acts_on(entity)) {
    throw UsageError("No size function acts on " + entity_name(entity) +
                     ": attach it, or leave --entity out.");
  }
  return [&field, entity](const Vec3* points, std::size_t count, double* sizes) {
    field.sizes(entity, points, count, sizes);
  };
}

/// Gmsh waits for ever for the answer of a server that has ended. So if the field cannot be made,
/// that is told on standard error, and all requests are answered by "no size", unless a terminal is
/// the input.
ExitCode serve(const ServeArguments& arguments) {
  const AnswerStream answers;
  std::optional<OpenedField> opened;
  SizesAt sizes;
  ExitCode result = done;
  try {
    if (arguments.field.calibrate) {
      throw UsageError(
          "Served sizes cannot be calibrated, since Gmsh does not tell which mesher asks: "
          "leave --calibrate out.");
    }
    opened.emplace(arguments.file, arguments.field);
    sizes = sizes_of(opened->field(), arguments.entity);
  } catch (const std::exception& error) {
    result = dynamic_cast<const UsageError*>(&error) != nullptr ? wrong_use : work_failed;
    if (::isatty(STDIN_FILENO) != 0) {
      throw;
    }
    tell(sentence_of(error), " Until then Gmsh gets no sizes from here.");
    sizes = no_sizes;
  }
  std::signal(SIGPIPE, SIG_IGN);  // not before: starting, Gmsh 4.15 sets it back
  const SizesAt answer = [&](const Vec3* points, std::size_t count, double* to) {
    try {
      sizes(points, count, to);
    } catch (const std::exception& error) {
      // A damaged part of a saved field, found when it is touched, or there is no memory.
      tell(sentence_of(error), " From here on Gmsh gets no sizes from here.");
      result = work_failed;
      sizes = no_sizes;
      sizes(points, count, to);
    }
  };
  if (serve_sizes(STDIN_FILENO, answers.descriptor(), answer) == ServeEnd::half_request) {
    tell("The input ended within a request: send three doubles for each.");
    result = work_failed;
  }
  return result;
}

}  // namespace

void serve_nothing() {
  if (::isatty(STDIN_FILENO) == 0) {
    std::signal(SIGPIPE, SIG_IGN);
    serve_sizes(STDIN_FILENO, STDOUT_FILENO, no_sizes);
  }
}

void add_serve_command(CLI::App& program) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App& command = *program.add_subcommand(
      "serve", "Answer stock Gmsh, whose field ExternalProcess starts this and asks for sizes");
  command
      .add_option("file", arguments->file,
                  "A saved field (.mgf), or a model or mesh with its size functions")
      ->required();
  command.add_option("--entity", arguments->entity,
                     "Sizes of this entity, for example 3,2 (default: the smallest of all)");
  add_field_options(command, arguments->field);
  command.footer(std::string("Example, in the .geo of an unchanged Gmsh:\n"
                             "  Field[1] = ExternalProcess;\n"
                             "  Field[1].CommandLine = \"meshgrow serve sizes.mgf\";\n"
                             "  Background Field = 1;\n") +
                 exit_codes_help);
  command.callback([arguments] {
    const ExitCode code = serve(*arguments);
    if (code != done) {
      throw CLI::RuntimeError(code);
    }
  });
}

}  // namespace meshgrow::cli
