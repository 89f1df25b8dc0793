#include "canyon/fusion/verdict/innovation_record.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/messages.h"

namespace canyon::fusion {
namespace {

/// Beyond this many sigma an innovation says no more than that it is wrong.
constexpr double kMostInnovations = 1e6;
constexpr double kBinsPerOctave = 32.0;

}  // namespace

double InnovationRow::nis_per_dimension() const {
  return dimensions > 0 ? nis_sum / static_cast<double>(dimensions) : kNaN;
}

double InnovationRow::nis_median_ratio() const {
  std::int64_t below = 0;
  for (const auto& [size, number] : by_size) {
    below += number;
    if (2 * below < count) continue;
    const auto d = static_cast<double>(series.dimension());
    return std::exp2((size + 0.5) / kBinsPerOctave) * d / chi_square_threshold(0.5, d);
  }
  return kNaN;
}

void InnovationRecord::add(const UpdateReport& report) {
  const int n = report.dimension;
  if (n == 0) return;
  auto found = rows_.find(std::string_view(report.measurement));
  if (found == rows_.end()) {
    found = rows_.emplace(report.measurement, InnovationRow()).first;
    found->second.series = NormalSeries(n);
  }
  InnovationRow& row = found->second;
  ++row.count;
  row.refused += report.accepted ? 0 : 1;
  const double nis = std::min(report.nis, n * kMostInnovations * kMostInnovations);
  row.nis_sum += nis;
  row.dimensions += n;
  constexpr double kLeast = 1e-12;
  ++row.by_size[static_cast<int>(std::floor(kBinsPerOctave * std::log2(std::max(nis / n, kLeast))))];
  if (n != row.series.dimension()) return;
  if (row.parts > 0 && report.t != row.pending_t) complete(row);
  if (row.parts == 0) row.pending = Eigen::VectorXd::Zero(n);
  row.pending_t = report.t;
  row.pending += report.normalized.head(n).cwiseMin(kMostInnovations).cwiseMax(-kMostInnovations);
  ++row.parts;
}

void InnovationRecord::complete(InnovationRow& row) {
  if (row.parts == 0) return;
  row.series.add(row.pending_t, row.pending / std::sqrt(static_cast<double>(row.parts)));
  row.parts = 0;
}

std::map<std::string, InnovationRow> InnovationRecord::rows() const {
  std::map<std::string, InnovationRow> out;
  for (const auto& [name, row] : rows_) complete(out[name] = row);
  return out;
}

}  // namespace canyon::fusion
