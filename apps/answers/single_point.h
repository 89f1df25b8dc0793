#pragma once

#include <optional>

#include "canyon/core/output/json.h"
#include "canyon/gnss/single_point/receiver_comparison.h"
#include "canyon/gnss/single_point/recorded_data.h"

namespace canyon::apps {

/// What `gnss solve` says: as JSON, as text.
struct SinglePointAnswer {
  const gnss::RecordedData& data;
  const gnss::SinglePointResult& result;
  gnss::PositionStatistics error;                      ///< against the truth, where there is one
  std::optional<gnss::ReceiverComparison> comparison;  ///< with the receiver's own positions
};
/// How honest the covariances are, by the horizontal errors.
void add_reported(Json& json, const gnss::EllipseCoverage& reported);
Json single_point_json(const SinglePointAnswer& answer);
void print_single_point(const SinglePointAnswer& answer);

}  // namespace canyon::apps
