#include "canyon/apps/answers/map_report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/printed.h"

namespace canyon::apps {
namespace {

constexpr const char* kWithin[] = {"_5cm", "_10cm", "_20cm"};

Json parts_json(const std::vector<lidar::MapErrors>& parts) {
  Json out = Json::array();
  for (const lidar::MapErrors& e : parts)
    out.push_back({{"name", e.name},
                   {"points", e.points},
                   {"rms_m", or_null(e.rms_m)},
                   {"vertical_rms_m", or_null(e.up_rms_m)},
                   {"across_rms_m", or_null(e.across_rms_m)},
                   {"signed_mean_m", or_null(e.signed_mean_m)}});
  return out;
}

Json trajectory_json(const lidar::TrajectoryErrors& e, const std::string& alignment) {
  Json relative = Json::array();
  for (const lidar::RelativeErrors& r : e.relative)
    relative.push_back({{"over", r.over},
                        {"pairs", r.pairs},
                        {"translation_rms_m", or_null(r.translation_rms_m)},
                        {"rotation_rms_deg", or_null(r.rotation_rms_deg)}});
  return {{"poses", e.poses},
          {"alignment", alignment},
          {"alignment_determined", e.alignment_determined},
          {"ate_rms_m", or_null(e.ate_rms_m)},
          {"ate_mean_m", or_null(e.ate_mean_m)},
          {"ate_median_m", or_null(e.ate_median_m)},
          {"ate_max_m", or_null(e.ate_max_m)},
          {"rotation_rms_deg", or_null(e.rotation_rms_deg)},
          {"rpe", relative}};
}

std::string shown(double value, const char* unit) {
  return std::isfinite(value) ? printed("%.4g %s", value, unit) : "-";
}

std::string percent(double share) {
  return std::isfinite(share) ? printed("%.1f %%", 100.0 * share) : "-";
}

std::string parts_text(const std::vector<lidar::MapErrors>& parts) {
  std::string out;
  for (const lidar::MapErrors& e : parts)
    out += printed("  %-18s %9lld points  rms %s, up %s, across %s, signed mean %s\n", e.name.c_str(),
                   static_cast<long long>(e.points), shown(e.rms_m, "m").c_str(), shown(e.up_rms_m, "m").c_str(),
                   shown(e.across_rms_m, "m").c_str(), shown(e.signed_mean_m, "m").c_str());
  return out;
}

std::string trajectory_text(const lidar::TrajectoryErrors& e, const std::string& alignment) {
  std::string out = printed("Trajectory (alignment %s%s): %lld poses, ATE rms %s, largest %s, rotation %s\n",
                            alignment.c_str(), e.alignment_determined ? "" : ", not determined",
                            static_cast<long long>(e.poses), shown(e.ate_rms_m, "m").c_str(),
                            shown(e.ate_max_m, "m").c_str(), shown(e.rotation_rms_deg, "deg").c_str());
  for (const lidar::RelativeErrors& r : e.relative)
    out += printed("  RPE over %-6s %s, %s (%lld pairs)\n", r.over.c_str(), shown(r.translation_rms_m, "m").c_str(),
                   shown(r.rotation_rms_deg, "deg").c_str(), static_cast<long long>(r.pairs));
  return out;
}

}  // namespace

Json map_answer_json(const MapAnswer& answer) {
  const lidar::MapReport& r = answer.map;
  Json out{{"points", r.points},
           {"capped_points", r.capped_points},
           {"rms_m", or_null(r.all.rms_m)},
           {"up_rms_m", or_null(r.level_up_rms_m)},
           {"vertical_rms_m", or_null(r.all.up_rms_m)},
           {"across_rms_m", or_null(r.all.across_rms_m)},
           {"signed_mean_m", or_null(r.all.signed_mean_m)},
           {"p95_m", or_null(r.p95_m)}};
  for (std::size_t k = 0; k < lidar::kWithin_m.size(); ++k) {
    out[std::string("accuracy") + kWithin[k]] = or_null(r.accuracy[k]);
    out[std::string("completeness") + kWithin[k]] = or_null(r.completeness[k]);
    out[std::string("f_score") + kWithin[k]] = or_null(r.f_score[k]);
  }
  out["completeness_of"] = answer.completeness_of;
  out["true_points"] = r.true_points;
  out["chamfer_m"] = or_null(r.chamfer_m);
  out["mean_map_entropy"] = or_null(r.consistency.mean_map_entropy);
  out["mean_plane_variance_m2"] = or_null(r.consistency.mean_plane_variance_m2);
  out["walls"] = {{"patches", r.walls.patches},
                  {"thickness_median_m", or_null(r.walls.median_m)},
                  {"thickness_p95_m", or_null(r.walls.p95_m)},
                  {"doubled_share", or_null(r.walls.doubled_share)},
                  {"doubled_gap_median_m", or_null(r.walls.doubled_gap_median_m)}};
  out["by_material"] = parts_json(r.by_material);
  out["by_range"] = parts_json(r.by_range);
  if (answer.trajectory) out["trajectory"] = trajectory_json(*answer.trajectory, answer.alignment);
  return out;
}

std::string map_answer_text(const MapAnswer& answer) {
  const lidar::MapReport& r = answer.map;
  std::string out = printed(
      "%lld points: rms %s, 95 %% within %s, height rms over level ground %s, signed mean %s; %lld without surface\n",
      static_cast<long long>(r.points), shown(r.all.rms_m, "m").c_str(), shown(r.p95_m, "m").c_str(),
      shown(r.level_up_rms_m, "m").c_str(), shown(r.all.signed_mean_m, "m").c_str(),
      static_cast<long long>(r.capped_points));
  for (std::size_t k = 0; k < lidar::kWithin_m.size(); ++k)
    out += printed("Within %2.0f cm: accuracy %s, completeness %s, F-score %s\n", 100.0 * lidar::kWithin_m[k],
                   percent(r.accuracy[k]).c_str(), percent(r.completeness[k]).c_str(), percent(r.f_score[k]).c_str());
  out += printed("Completeness is of %lld points of %s; Chamfer distance %s\n", static_cast<long long>(r.true_points),
                 answer.completeness_of.c_str(), shown(r.chamfer_m, "m").c_str());
  out += printed("Walls: %lld patches, thickness median %s, 95th percentile %s; doubled %s\n",
                 static_cast<long long>(r.walls.patches), shown(r.walls.median_m, "m").c_str(),
                 shown(r.walls.p95_m, "m").c_str(), percent(r.walls.doubled_share).c_str());
  out += printed("Without truth: mean map entropy %s, mean plane variance %s\n",
                 shown(r.consistency.mean_map_entropy, "nats").c_str(),
                 shown(r.consistency.mean_plane_variance_m2, "m^2").c_str());
  out += "By material\n" + parts_text(r.by_material);
  if (!r.by_range.empty()) out += "By range\n" + parts_text(r.by_range);
  if (answer.trajectory) out += trajectory_text(*answer.trajectory, answer.alignment);
  return out;
}

}  // namespace canyon::apps
