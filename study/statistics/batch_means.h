#pragma once

#include <vector>

#include "canyon/study/statistics/interval.h"

namespace canyon::study {

/// Mean over time of a quantity whose samples are alike for a while, with an interval that knows it: Student's, over
/// means of batches of kBatch_s, whatever is left over at the end being part of the last batch (method of batch means:
/// Law & Kelton, Simulation Modeling and Analysis, section 9.5.3). Errors of a filter are alike for about ten seconds,
/// so single epochs are no independent sample. Keeps two numbers per batch, and the samples of the last one.
class BatchMeans {
 public:
  static constexpr double kBatch_s = 30.0;

  /// Times must not go back.
  void add(double t_s, double value);

  int samples() const { return samples_; }
  double mean() const { return samples_ > 0 ? sum_ / samples_ : kNaN; }
  /// None with fewer than two batches.
  Interval interval() const;

 private:
  struct Batch {
    double sum = 0.0, count = 0.0;
  };
  double start_s_ = 0.0, sum_ = 0.0;
  int samples_ = 0;
  std::vector<Batch> complete_;
  std::vector<double> open_;  ///< of the batch that has not come to its end
};

}  // namespace canyon::study
