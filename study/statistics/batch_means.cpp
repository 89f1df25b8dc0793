#include "canyon/study/statistics/batch_means.h"

#include <cstddef>

#include "canyon/study/statistics/sample.h"

namespace canyon::study {

void BatchMeans::add(double t_s, double value) {
  if (samples_ == 0) start_s_ = t_s;
  const auto batch = static_cast<std::size_t>((t_s - start_s_) / kBatch_s);
  if (batch > complete_.size()) {
    Batch done;
    for (const double v : open_) done.sum += v, done.count += 1.0;
    complete_.push_back(done);
    complete_.resize(batch);  // a gap in time leaves batches without samples
    open_.clear();
  }
  open_.push_back(value);
  sum_ += value;
  ++samples_;
}

Interval BatchMeans::interval() const {
  std::vector<Batch> batches = complete_;
  if (batches.size() < 2) return {};
  for (const double v : open_) batches.back().sum += v, batches.back().count += 1.0;
  double squares = 0.0, used = 0.0;
  for (const Batch& batch : batches) {
    if (batch.count == 0.0) continue;
    const double deviation = batch.sum / batch.count - mean();
    squares += deviation * deviation;
    used += 1.0;
  }
  if (used < 2.0) return {};
  const double sigma = std::sqrt(squares / (used - 1) / used);
  const double reach = student_975(static_cast<int>(used) - 1) * sigma;
  return {mean() - reach, mean() + reach};
}

}  // namespace canyon::study
