#include "field_summary.h"

#include <sstream>

#include "number_text.h"
#include "text_table.h"

namespace meshgrow {

namespace {

using Rows = std::vector<std::vector<std::string>>;

/// What the function's kind needs to know.
std::string own_parameter(const SizeFunction& function) {
  std::string text;
  if (function.kind == Kind::fixed) {
    text = "size " + shortest(function.start_size);
  } else if (function.kind == Kind::curvature) {
    text = "angle " + shortest(function.angle);
  } else if (function.kind == Kind::proximity) {
    text = shortest(function.cells_per_gap) + " cells per gap";
  }
  if (function.min_size > 0.0) {
    text += ", min " + shortest(function.min_size);
  }
  return text.empty() ? "-" : text;
}

std::string function_table(const SizeField& field) {
  Rows rows = {
      {"size function", "sources", "attachments", "parameter", "growth", "limit", "facets", ""}};
  for (std::size_t i = 0; i < field.functions().size(); ++i) {
    const SizeFunction& function = field.functions()[i];
    const bool acts = field.is_effective(i);
    rows.push_back({field.function_name(i), entity_names(function.sources, 3),
                    entity_names(function.attachments, 3), own_parameter(function),
                    shortest(function.growth_rate), shortest(function.size_limit),
                    acts ? grouped_digits(field.facet_count(i)) : "-",
                    acts ? "" : "no effect: its sources have no mesh yet"});
  }
  return text_table(rows, {1, 2, 3, 7});
}

std::string megabytes(std::size_t bytes) { return rounded(static_cast<double>(bytes) / 1e6, 1); }

std::string group_table(const SizeField& field) {
  Rows rows = {{"group", "entities", "functions", "facets", "tree MB", "grid cells", "exact",
                "depth", "grid MB", "seconds", "sizes answered", "exactly"}};
  for (const SizeField::GroupSummary& group : field.groups()) {
    std::string functions;
    for (const std::size_t function : group.functions) {
      functions += (functions.empty() ? "" : ", ") + field.functions()[function].name;
    }
    std::vector<std::string> row = {
        "Group " + std::to_string(rows.size()),
        entity_names({group.entities.rbegin(), group.entities.rend()}, 2), functions,
        grouped_digits(group.facets), group.facets > 0 ? megabytes(group.tree_bytes) : "-"};
    if (group.has_grid) {
      const BackgroundGrid::Statistics& grid = group.grid;
      row.insert(row.end(), {grouped_digits(grid.interpolated_leaves + grid.exact_leaves),
                             grouped_digits(grid.exact_leaves), std::to_string(grid.depth),
                             megabytes(grid.bytes)});
    } else {
      row.insert(row.end(), {"no grid", "-", "-", "-"});
    }
    const double seconds = group.tree_seconds + (group.has_grid ? group.grid.seconds : 0.0);
    row.push_back(group.facets > 0 ? rounded(seconds, 2) : "-");
    row.push_back(grouped_digits(group.answers));
    const double share =
        static_cast<double>(group.exact_answers) / static_cast<double>(group.answers);
    row.push_back(group.answers > 0 ? rounded(100.0 * share, 0) + " %" : "-");
    rows.push_back(std::move(row));
  }
  return text_table(rows, {1, 2});
}

}  // namespace

std::string summary_table(const SizeField& field) {
  return field.functions().empty() ? "" : function_table(field) + '\n' + group_table(field);
}

std::string SizeField::summary() const { return summary_table(*this); }

}  // namespace meshgrow
