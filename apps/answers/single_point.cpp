#include "canyon/apps/answers/single_point.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace canyon::apps {

namespace {

/// The keys of what differs, in the order of the summary.
void add_statistics(Json& json, const gnss::PositionStatistics& s) {
  const char* const axes[] = {"e", "n", "u"};
  for (int i = 0; i < 3; ++i) json[std::string("mean_") + axes[i] + "_m"] = or_null(s.mean_enu_m[i]);
  for (int i = 0; i < 3; ++i) json[std::string("std_") + axes[i] + "_m"] = or_null(s.std_enu_m[i]);
  json["h50_m"] = or_null(s.h50_m);
  json["h95_m"] = or_null(s.h95_m);
  json["v95_m"] = or_null(s.v95_m);
  json["rms_3d_m"] = or_null(s.rms_3d_m);
}

void print_statistics(const gnss::PositionStatistics& s, const char* what) {
  std::printf("  %-8s %8s %7s\n", what, "mean", "std");
  const char* axes[] = {"east", "north", "up"};
  for (int i = 0; i < 3; ++i) std::printf("  %-7s  %8.3f %7.3f\n", axes[i], s.mean_enu_m[i], s.std_enu_m[i]);
  std::printf("  horizontal 50 %% %.3f, 95 %% %.3f; vertical 95 %% %.3f; 3-D RMS %.3f m\n", s.h50_m, s.h95_m, s.v95_m,
              s.rms_3d_m);
}

}  // namespace

void add_reported(Json& json, const gnss::EllipseCoverage& reported) {
  json["ellipse_50_share"] = or_null(reported.inside(0.5));
  json["ellipse_95_share"] = or_null(reported.inside(0.95));
  json["ellipse_997_share"] = or_null(reported.inside(0.997));
  json["beyond_3_sigma"] = or_null(reported.beyond_3_sigma());
  json["horizontal_log_score"] = or_null(reported.log_score());
}

Json single_point_json(const SinglePointAnswer& answer) {
  const gnss::PositionStatistics& s = answer.error;
  const gnss::ObservationFile& file = answer.data.observations;
  Json json{{"epochs", s.epochs}, {"solved", s.solved}, {"compared", s.compared}};
  add_statistics(json, s);
  const char* const axes[] = {"e", "n", "u"};
  for (int i = 0; i < 3; ++i)
    json[std::string("velocity_rms_") + axes[i] + "_m_s"] = or_null(s.velocity_rms_enu_m_s[i]);
  if (s.reported.count() > 0) add_reported(json, s.reported);
  json["damaged_records"] = file.damaged;
  json["other_system_satellites"] = file.other_system_satellites;
  json["warnings"] = answer.result.warnings.size() + file.warnings.size();
  json["skipped_navigation_records"] = Json::object();
  for (const auto& [kind, count] : answer.data.navigation.skipped_records)
    json["skipped_navigation_records"][kind] = count;
  json["unsolved"] = Json::object();
  for (const auto& [reason, count] : answer.result.reasons) json["unsolved"][reason] = count;
  if (!answer.comparison) return json;
  const gnss::ReceiverComparison& c = *answer.comparison;
  json["compare"] = {{"file", c.file}, {"positions", c.records}, {"compared", c.difference.compared}};
  add_statistics(json["compare"], c.difference);
  return json;
}

void print_single_point(const SinglePointAnswer& answer) {
  const gnss::ObservationFile& file = answer.data.observations;
  std::printf("%s: %d epochs from %s GPS time, %d solved\n", file.name.c_str(), answer.error.epochs,
              file.epochs.front().t.iso(0).c_str(), answer.error.solved);
  for (const auto& [reason, count] : answer.result.reasons) std::printf("  %6d without: %s\n", count, reason.c_str());
  if (file.other_system_satellites > 0)
    std::printf("  %6d observations of satellites of other systems, not used\n", file.other_system_satellites);
  if (const std::string skipped = answer.data.navigation.skipped(); !skipped.empty())
    std::printf("  navigation records not used: %s\n", skipped.c_str());
  if (answer.error.compared > 0) print_statistics(answer.error, "error, m");
  if (!answer.comparison) return;
  const gnss::ReceiverComparison& c = *answer.comparison;
  std::printf("  against %s: %d of its %d positions are at times of ours; ours minus its own:\n", c.file.c_str(),
              c.difference.compared, c.records);
  if (c.difference.compared > 0) print_statistics(c.difference, "diff., m");
}

}  // namespace canyon::apps
