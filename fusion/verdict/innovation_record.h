#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/verdict/normal_series.h"

namespace canyon::fusion {

/// What the innovations of one row of measurements were, of the noise as stated: before an acceptance weighs or refuses
/// them.
struct InnovationRow {
  std::int64_t count = 0, refused = 0;
  double nis_sum = 0.0;
  std::int64_t dimensions = 0;
  /// Normalized innovations, elements independent and unit normal if the filter is right. What comes in several parts
  /// at one instant (satellites) counts as one: the sum of the parts over the root of their number.
  NormalSeries series;
  /// How many NIS per dimension are in [2^(k/32), 2^((k+1)/32)).
  std::map<int, std::int64_t> by_size;

  double nis_per_dimension() const;
  /// Median of NIS over that of a right filter's, to 2 %; NaN without any.
  double nis_median_ratio() const;

  GpsTime pending_t;
  Eigen::VectorXd pending;
  int parts = 0;
};

/// The innovations of a run, measurement by measurement.
class InnovationRecord {
 public:
  /// A report of dimension 0 says nothing.
  void add(const UpdateReport& report);
  /// All that has come, by rows of measurement_models().
  std::map<std::string, InnovationRow> rows() const;

 private:
  static void complete(InnovationRow& row);
  std::map<std::string, InnovationRow, std::less<>> rows_;
};

}  // namespace canyon::fusion
