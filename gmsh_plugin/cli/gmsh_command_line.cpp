#include "gmsh_command_line.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "usage_error.h"

namespace meshgrow::cli {

namespace {

/// Options that Gmsh 4.8 and later read, with the number of their values.
const std::map<std::string, int>& taken() {
  static const std::map<std::string, int> values_of = {// What is meshed, and how.
                                                       {"-algo", 1},
                                                       {"-order", 1},
                                                       {"-degree", 1},
                                                       {"-clmin", 1},
                                                       {"-clmax", 1},
                                                       {"-clscale", 1},
                                                       {"-clcurv", 1},
                                                       {"-clcurviso", 0},
                                                       {"-clextend", 1},
                                                       {"-epslc1d", 1},
                                                       {"-edgelmin", 1},
                                                       {"-swapangle", 1},
                                                       {"-rand", 1},
                                                       {"-smooth", 1},
                                                       {"-quad", 0},
                                                       {"-optimize", 0},
                                                       {"-optimize_threshold", 1},
                                                       {"-optimize_netgen", 0},
                                                       {"-optimize_ho", 0},
                                                       {"-hoOptimize", 0},
                                                       {"-ho_min", 1},
                                                       {"-ho_max", 1},
                                                       {"-ho_nlayers", 1},
                                                       {"-aniso_max", 1},
                                                       {"-anisoMax", 1},
                                                       {"-smooth_ratio", 1},
                                                       {"-smoothRatio", 1},
                                                       {"-ignore_periodicity", 0},
                                                       {"-ignorePeriodicity", 0},
                                                       {"-tol", 1},
                                                       {"-nt", 1},
                                                       // What is written.
                                                       {"-format", 1},
                                                       {"-f", 1},
                                                       {"-vmsh", 1},
                                                       {"-bin", 0},
                                                       {"-saveall", 0},
                                                       {"-save_all", 0},
                                                       {"-save_parametric", 0},
                                                       {"-parametric", 0},
                                                       {"-save_topology", 0},
                                                       {"-save_entities", 0},
                                                       {"-switch_tags", 0},
                                                       {"-meshscale", 1},
                                                       {"-preserve_numbering_msh2", 0},
                                                       {"-preserveNumberingMsh2", 0},
                                                       {"-part", 1},
                                                       {"-part_topo", 0},
                                                       {"-part_no_topo", 0},
                                                       {"-part_ghosts", 0},
                                                       {"-part_no_ghosts", 0},
                                                       {"-part_physicals", 0},
                                                       {"-part_no_physicals", 0},
                                                       // Input and messages.
                                                       {"-setnumber", 2},
                                                       {"-setstring", 2},
                                                       {"-string", 1},
                                                       {"-option", 1},
                                                       {"-merge", 0},
                                                       {"-v", 1},
                                                       {"-verbose", 1},
                                                       {"-log", 1},
                                                       {"-cpu", 0},
                                                       {"-pid", 0},
                                                       {"-nopopup", 0},
                                                       {"-noenv", 0},
                                                       {"-nolocale", 0}};
  return values_of;
}

/// Why gmsh's other options are not taken.
std::string reason(const std::string& option) {
  struct Group {
    std::vector<std::string> options;
    const char* reason;
  };
  static const std::vector<Group> groups = {
      {{"-0", "-4", "-refine", "-barycentric_refine", "-reclassify", "-reparam", "-quadlayout",
        "-hybrid", "-size_field", "-convert", "-check"},
       "it asks for other work than meshing; run gmsh itself for that"},
      {{"-bgm"}, "let the .geo merge the file and set a PostView field as background field"},
      {{"-new", "-open"}, "one run meshes one model; run it once for each"},
      {{"-part_split", "-part_split_files", "-oneFilePerPart", "-part_topo_pro",
        "-savePartTopology"},
       "it writes more than one file; run gmsh with it on the mesh afterwards"},
      {{"-part_weight", "-partWeight"}, "set Mesh.PartitionTetWeight and so on with -setnumber"},
      {{"-statreport", "-append_statreport"}, "use --report"},
      {{"-run", "-onelab", "-socket", "-listen", "-minterpreter", "-pyinterpreter"},
       "solvers are not run; run gmsh itself for that"},
      {{"-version", "-info", "-help", "-help_options"}, "use meshgrow --version or --help"},
      {{"-a",       "-g",      "-m",           "-s",        "-p",
        "-n",       "-nomesh", "-noview",      "-link",     "-smoothview",
        "-combine", "-nodb",   "-numsubedges", "-fontsize", "-deltafontsize",
        "-theme",   "-scheme", "-display",     "-camera",   "-stereo",
        "-gamepad", "-watch",  "-windows",     "-tiles",    "-bg",
        "-dual",    "-voronoi"},
       "no window is opened; leave it out"}};
  for (const Group& group : groups) {
    if (std::count(group.options.begin(), group.options.end(), option) > 0) {
      return group.reason;
    }
  }
  return "'meshgrow mesh --help' lists those that are";
}

/// Moves arguments from one list to the other.
class Reader {
 public:
  explicit Reader(const std::vector<std::string>& arguments) : arguments_(arguments) {}
  bool at_end() const { return next_ == arguments_.size(); }
  const std::string& next() { return arguments_[next_++]; }

  void take_values(const std::string& option, std::size_t count,
                   std::vector<std::string>& destination) {
    if (arguments_.size() - next_ < count) {
      throw UsageError("gmsh's option " + option + " lacks " +
                       (count == 1 ? "its value" : "one of its values") + ": add it.");
    }
    for (std::size_t i = 0; i < count; ++i) {
      destination.push_back(next());
    }
  }

 private:
  const std::vector<std::string>& arguments_;
  std::size_t next_ = 0;
};

bool has_value(const CLI::App& command, const std::string& option) {
  const CLI::Option* known = command.get_option_no_throw(option);
  return known != nullptr && known->get_items_expected_max() > 0;
}

}  // namespace

GmshCommandLine take_gmsh_options(const CLI::App& command, std::vector<std::string>& arguments) {
  using Task = GmshCommandLine::Task;
  GmshCommandLine result;
  std::vector<std::string> others;
  Reader reader(arguments);
  while (!reader.at_end()) {
    const std::string argument = reader.next();
    if (argument == "-1" || argument == "-2" || argument == "-3") {
      result.task = Task::mesh;
      result.dim = argument[1] - '0';
    } else if (argument == "-" || argument == "-parse_and_exit") {
      result.task = Task::parse;
    } else if (argument == "-save") {
      result.task = Task::save;
    } else if (argument == "-setlist" || argument == "-setlistofnumbers") {
      result.options.push_back(argument);
      reader.take_values(argument, 2, result.options);
      const int count = std::atoi(result.options.back().c_str());
      reader.take_values(argument, static_cast<std::size_t>(std::max(count, 0)), result.options);
    } else if (const auto found = taken().find(argument); found != taken().end()) {
      result.options.push_back(argument);
      reader.take_values(argument, static_cast<std::size_t>(found->second), result.options);
      result.part = result.part || argument == "-part";
    } else if (argument.size() > 1 && argument[0] == '-' && argument[1] != '-' &&
               command.get_option_no_throw(argument) == nullptr) {
      throw UsageError("gmsh's option " + argument +
                       " is not taken by meshgrow mesh: " + reason(argument) + ".");
    } else {
      others.push_back(argument);
      if (has_value(command, argument) && !reader.at_end()) {
        others.push_back(reader.next());
      }
    }
  }
  arguments = std::move(others);
  return result;
}

std::string gmsh_options_help() {
  std::string text =
      "gmsh's own options, which mean what they mean to gmsh:\n  -1 -2 -3 (the default) - -save";
  std::size_t width = text.size() - text.rfind('\n');
  for (const auto& [name, values] : taken()) {
    constexpr std::size_t line = 78;
    if (width + 1 + name.size() > line) {
      text += "\n ";
      width = 1;
    }
    text += " " + name;
    width += 1 + name.size();
  }
  return text + " -setlist";
}

}  // namespace meshgrow::cli
