#ifndef MESHGROW_BENCHMARKS_KERNELS_RESULTS_H
#define MESHGROW_BENCHMARKS_KERNELS_RESULTS_H

#include <string>
#include <vector>

namespace meshgrow::kernels {

/// Where a number stands in the results: its name, then where there are several its input, and the
/// place or order of its points.
using Path = std::vector<std::string>;

struct Spread {
  double median = 0.0;
  double low = 0.0;
  double high = 0.0;
};

Spread spread_of(std::vector<double> values);

/// All numbers of a run with one value for each repetition.
class Results {
 public:
  void add(const Path& path, double value);

  /// The values so far, in the order of the repetitions; none where the path is unknown.
  std::vector<double> values(const Path& path) const;

  /// The table with each number beside its bar.
  void print() const;

  /// Merges the numbers into the JSON file, which need not exist: one object with a key for each
  /// name. Keeps what else the file holds; Error where it is not JSON or cannot be written.
  void merge_into(const std::string& json_file) const;

 private:
  struct Series {
    Path path;
    std::vector<double> values;
  };

  std::vector<Series> series_;
};

}  // namespace meshgrow::kernels

#endif
