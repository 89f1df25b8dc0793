#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/printed.h"
#include "canyon/study/registration_error/response/error_response.h"

namespace canyon::study {
namespace {

Json healed_json(const ResponsePoint& point) {
  return {{"size", point.size},
          {"prior_m", or_null(point.prior_m)},
          {"registered_m", or_null(point.registered_m)},
          {"healed", or_null(point.healed.value)},
          {"low", or_null(point.healed.interval.low)},
          {"high", or_null(point.healed.interval.high)},
          {"unaligned", or_null(point.unaligned)}};
}

/// A size beyond all that were tried is no number of JSON.
Json size_or_beyond(double size) {
  if (std::isinf(size)) return "beyond";
  return or_null(size);
}

Json series_json(const std::vector<ResponsePoint>& points, const EstimatedNumber& half) {
  Json sizes = Json::array();
  for (const ResponsePoint& point : points) sizes.push_back(healed_json(point));
  return {{"points", sizes},
          {"half_healed_up_to", size_or_beyond(half.value)},
          {"low", size_or_beyond(half.interval.low)},
          {"high", size_or_beyond(half.interval.high)}};
}

Json response_curve_json(const ResponseCurve& curve) {
  Json out{{"method", curve.method}, {"kind", curve.kind}};
  out["axis"] = curve.axis.empty() ? Json() : Json(curve.axis);
  out["from_m"] = curve.from_m ? Json(*curve.from_m) : Json();
  out["keyframe"] = series_json(curve.keyframe, curve.keyframe_half);
  out["map"] = series_json(curve.map, curve.map_half);
  return out;
}

std::string response_cell(double value) {
  return std::isfinite(value) ? printed("%.9g", value) : "";
}

void add_rows(const ResponseCurve& curve, const char* series, const std::vector<ResponsePoint>& points,
              std::string& out) {
  for (const ResponsePoint& point : points)
    out += printed("%s,%s,%s,%s,%g,%s,", curve.method.c_str(), curve.kind.c_str(), curve.axis.c_str(),
                   curve.from_m ? printed("%g", *curve.from_m).c_str() : "", point.size, series) +
           response_cell(point.prior_m) + ',' + response_cell(point.registered_m) + ',' +
           response_cell(point.healed.value) + ',' + response_cell(point.healed.interval.low) + ',' +
           response_cell(point.healed.interval.high) + ',' + response_cell(point.unaligned) + '\n';
}

/// "below" and "beyond" the sizes that were tried.
std::string half_word(double size) {
  if (std::isnan(size)) return "-";
  if (size == 0.0) return "below";
  return std::isinf(size) ? "beyond" : printed("%.2g", size);
}

std::string half_words(const EstimatedNumber& half) {
  std::string out = half_word(half.value);
  if (!std::isnan(half.interval.low))
    out += " [" + half_word(half.interval.low) + ", " + half_word(half.interval.high) + "]";
  return out;
}

std::string response_line(const ResponseCurve& curve, const char* series, const std::vector<ResponsePoint>& points,
                          const EstimatedNumber& half) {
  std::string out = printed("  %-18s %-9s", curve.method.c_str(), series);
  for (const ResponsePoint& point : points) out += printed(" %7.2f", point.healed.value);
  return out + "   " + half_words(half) + "\n";
}

std::string sweep_head(const ResponseCurve& curve) {
  std::string out = "\n" + curve.kind + (curve.axis.empty() ? "" : ", " + curve.axis);
  out.resize(std::max<std::size_t>(out.size(), 31), ' ');
  for (const ResponsePoint& point : curve.keyframe) out += printed(" %7g", point.size);
  return out + "   half up to\n";
}

/// "by place, half up to: 0 m below, 100 m 3.1, ...".
std::string places_line(const std::vector<ResponseCurve>& curves, const ResponseCurve& of) {
  std::string out;
  for (const ResponseCurve& curve : curves)
    if (curve.from_m && curve.method == of.method && curve.kind == of.kind && curve.axis == of.axis)
      out += (out.empty() ? "" : ", ") + printed("%g m ", *curve.from_m) + half_word(curve.keyframe_half.value);
  return "  " + of.method + ", keyframes from: " + out + "\n";
}

}  // namespace

Json error_response_json(const ErrorResponse& response) {
  Json out{{"mission", response.mission},
           {"fidelity", response.fidelity},
           {"tape", response.tape},
           {"seed", response.seed},
           {"seeds", response.seeds},
           {"stretch_m", response.stretch_m},
           {"places_from_m", response.places_from_m}};
  Json kinds = Json::object();
  for (const auto& row : estimate_errors()) kinds[row.name] = row.doc;
  out["kinds"] = kinds;
  Json undisturbed = Json::array(), curves = Json::array();
  for (const UndisturbedError& of : response.undisturbed)
    undisturbed.push_back({{"method", of.method},
                           {"keyframe_m", or_null(of.keyframe_m)},
                           {"map_m", or_null(of.map_m)},
                           {"map_at_true_poses_m", or_null(of.prior_map_m)}});
  for (const ResponseCurve& curve : response.curves) curves.push_back(response_curve_json(curve));
  out["undisturbed"] = undisturbed;
  out["curves"] = curves;
  out["timing"] = {{"cpu_s", response.cpu_s}};
  return out;
}

std::string error_response_csv(const ErrorResponse& response) {
  std::string out = "method,kind,axis,from_m,size,series,prior_m,registered_m,healed,low,high,unaligned\n";
  for (const ResponseCurve& curve : response.curves) {
    add_rows(curve, "keyframe", curve.keyframe, out);
    add_rows(curve, "map", curve.map, out);
  }
  return out;
}

std::string error_response_table(const ErrorResponse& response) {
  std::string out =
      printed("%s, %s: %lld seed%s, %zu place%s of %g m. Healed: 1 - registered / prior.\n", response.mission.c_str(),
              response.fidelity.c_str(), static_cast<long long>(response.seeds), response.seeds == 1 ? "" : "s",
              response.places_from_m.size(), response.places_from_m.size() == 1 ? "" : "s", response.stretch_m);
  for (const UndisturbedError& of : response.undisturbed)
    out += printed("  %s without an error: keyframes %.3f m off, map %.3f m (at true poses %.3f m)\n",
                   of.method.c_str(), of.keyframe_m, of.map_m, of.prior_map_m);
  for (const ResponseCurve& first : response.curves) {
    if (first.from_m || first.method != response.undisturbed.front().method) continue;
    out += sweep_head(first);
    for (const ResponseCurve& curve : response.curves) {
      if (curve.from_m || curve.kind != first.kind || curve.axis != first.axis) continue;
      out += response_line(curve, "keyframe", curve.keyframe, curve.keyframe_half);
      out += response_line(curve, "map", curve.map, curve.map_half);
    }
    for (const UndisturbedError& of : response.undisturbed)
      if (of.method != "none")
        for (const ResponseCurve& curve : response.curves)
          if (!curve.from_m && curve.method == of.method && curve.kind == first.kind && curve.axis == first.axis)
            out += places_line(response.curves, curve);
  }
  return out;
}

}  // namespace canyon::study
