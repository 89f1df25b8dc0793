#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/imu_log.h"
#include "canyon/report/draw/time_plot.h"

namespace canyon::apps {

namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

struct Options {
  CommonOptions common;
  std::string imu, columns, truth, initial, at_rest, axes = "flu", gravity, out;
  std::string integrator = "two_sample";
  double level_s = 10.0;
  bool force = false;
};

/// Whether the file begins with a number: then it has no header, and is taken for the KF-GINS text format.
Result<bool> is_bare(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  const std::size_t at = text.find_first_not_of(" \t\r\n");
  return at != std::string::npos && std::string_view("0123456789.-+").find(text[at]) != std::string_view::npos;
}

struct Recording {
  std::vector<ImuSample> samples;
  bool kf_gins = false;  ///< the text format
  std::size_t gaps = 0;
};

/// Stamps as instants: 292 years from the GPS epoch are what nanoseconds in 64 bits hold.
Status check_stamps(const Options& options, const inertial::ImuLog& log, int week) {
  const double most_s = 9.2e9 - kSecondsPerWeek * (week + 1);
  if (std::max(std::abs(log.t_s.front()), std::abs(log.t_s.back())) < most_s) return Ok{};
  char text[80];
  std::snprintf(text, sizeof text, "stamps from %.6g to %.6g s", log.t_s.front(), log.t_s.back());
  return Error{options.imu, 0, "", text, "seconds of the truth's GPS week"};
}

/// Increments over the interval that ends at each stamp, in forward-left-up; the first interval and those behind gaps
/// are as long as usual. Stamps are seconds of `week`.
Result<Recording> read_imu(const Options& options, int week) {
  CANYON_TRY(const bool bare, is_bare(options.imu));
  Recording out;
  out.kf_gins = options.columns == "kf_gins" || (options.columns.empty() && bare);
  inertial::ImuLogFormat format;
  format.columns = out.kf_gins ? "kf_gins" : options.columns;
  auto log = inertial::read_imu_log(options.imu, format);
  if (!log) {
    // What only a dead or saturated channel speaks against can still be integrated.
    const Error refused = log.error();
    format.live = false;
    log = inertial::read_imu_log(options.imu, format);
    if (!log) return log.error();
    std::fprintf(stderr, "warning: %s\n", refused.str().c_str());
  }
  for (const std::string& doubt : log->doubts) std::fprintf(stderr, "warning: %s\n", doubt.c_str());
  CANYON_TRY_STATUS(check_stamps(options, *log, week));
  for (int c = 0; c < 6; ++c)
    if (log->channels[static_cast<std::size_t>(c)].empty())
      return Error{options.imu, 0, "", std::string("no column for ") + inertial::kChannelNames[c], "all six channels"};
  const Eigen::Vector3d sign =
      options.axes == "frd" && !out.kf_gins ? Eigen::Vector3d(1, -1, -1) : Eigen::Vector3d(1, 1, 1);
  const inertial::Sampling sampling = inertial::sampling_of(log->t_s);
  out.gaps = sampling.segments.size() - 1;
  for (const inertial::Segment& segment : sampling.segments)
    for (std::size_t k = segment.begin; k < segment.end; ++k) {
      if (k % kSamplesPerLook == 0) throw_if_cancelled();
      const auto& c = log->channels;
      ImuSample s;
      s.t = GpsTime::from_week_sow(week, 0.0) + log->t_s[k];
      s.dt_s = k > segment.begin ? log->t_s[k] - log->t_s[k - 1] : sampling.interval_s;
      const double rate_s = log->increments[0] ? sampling.interval_s : s.dt_s;
      const double force_s = log->increments[1] ? sampling.interval_s : s.dt_s;
      s.dtheta_U = rate_s * sign.cwiseProduct(Eigen::Vector3d(c[0][k], c[1][k], c[2][k]));
      s.dv_U = force_s * sign.cwiseProduct(Eigen::Vector3d(c[3][k], c[4][k], c[5][k]));
      out.samples.push_back(s);
    }
  return out;
}

fusion::NavState state_of(const NavigationRecord& record) {
  return {.t = record.t, .R_EU = record.X_EU.R, .p_EU_E = record.X_EU.p, .v_EU_E = record.v_EU_E};
}

/// Where the integration starts and what it is compared with.
struct Reference {
  fusion::NavState initial;
  std::vector<fusion::NavState> truth;  ///< the start and what is behind it; empty: none
  std::string gravity;                  ///< that the truth file states
};

/// "12.000 to 34.000 s of the week" of the first; they go on past its end.
std::string of_week(GpsTime first, GpsTime last) {
  const GpsTime week = GpsTime::from_week_sow(first.week(), 0.0);
  char text[80];
  std::snprintf(text, sizeof text, "%.3f to %.3f s of the week", first - week, last - week);
  return text;
}

Result<fusion::NavState> start_in_truth(const std::vector<fusion::NavState>& truth,
                                        const std::vector<ImuSample>& samples, const Options& options) {
  if (const auto start = fusion::first_common_state(truth, samples)) return *start;
  return Error{
      options.truth, 0, "", "covers " + of_week(truth.front().t, truth.back().t),
      "times from " + of_week(samples.front().t - samples.front().dt_s, samples.back().t) + ", as in " + options.imu};
}

Result<Reference> from_initial(const Options& options, const std::vector<ImuSample>& samples) {
  CANYON_TRY(const auto v, parse_numbers(options.initial, 9, "--initial",
                                         "LAT,LON,H,VN,VE,VD,ROLL,PITCH,HEADING: degrees, metres, m/s"));
  NavigationRecord record;
  const Geodetic at{v[0] * kDegree, v[1] * kDegree, v[2]};
  const Eigen::Matrix3d enu = rotation_E_from_enu(at);
  record.t = samples.front().t;
  record.X_EU.p = ecef_from_geodetic(at);
  record.X_EU.R = attitude_from_ned(at, v[6] * kDegree, v[7] * kDegree, v[8] * kDegree);
  record.v_EU_E = enu * Eigen::Vector3d(v[4], v[3], -v[5]);
  return Reference{state_of(record), {}, ""};
}

/// At rest all the time: levelled with the mean force of the first seconds, heading as given.
Result<Reference> from_rest(const Options& options, const std::vector<ImuSample>& samples) {
  CANYON_TRY(const auto v, parse_numbers(options.at_rest, 4, "--static", "LAT,LON,H,HEADING: degrees, metres"));
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const ImuSample& s : samples) {
    if (s.t - samples.front().t > options.level_s) break;
    force += s.dv_U;
  }
  Reference out;
  out.initial = fusion::levelled({v[0] * kDegree, v[1] * kDegree, v[2]}, v[3] * kDegree, force);
  out.initial.t = samples.front().t;
  for (const ImuSample& s : samples) {
    out.truth.push_back(out.initial);
    out.truth.back().t = s.t;
  }
  return out;
}

/// Gravity must pull down in the first second, or as long as the unit keeps its attitude by half a radian; an axis
/// convention mistaken turns it round.
Status check_axes(const Options& options, const std::vector<ImuSample>& samples, const fusion::NavState& initial) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), turned = force;
  for (const ImuSample& s : samples) {
    if (s.t <= initial.t) continue;
    if (s.t - initial.t >= 1.0 || turned.norm() > 0.5) break;
    force += s.dv_U;
    turned += s.dtheta_U;
  }
  if ((initial.R_EU * force).dot(gravity_E(initial.p_EU_E)) <= 0.0) return Ok{};
  return Error{options.imu, 0, "", "in the initial attitude the specific force points down",
               options.axes == "frd" ? "--axes flu" : "forward-left-up axes, or --axes frd"};
}

struct Outcome {
  Recording recording;
  Reference reference;
  std::string gravity;
  std::vector<fusion::NavState> states;
  std::vector<fusion::NavError> errors;
  fusion::HeldErrors held;
  fusion::NavErrorStatistics statistics;  ///< of all errors
  fusion::NavErrorStatistics held_ones;   ///< of those that hold

  std::span<const fusion::NavError> held_errors() const { return std::span(errors).first(held.count); }
  bool holds() const { return !held.until.has_value(); }
  double since_start_s(GpsTime t) const { return t - states.front().t; }
};

Json vector_json(const Eigen::Vector3d& v) {
  return Json::array({or_null(v.x()), or_null(v.y()), or_null(v.z())});
}

/// Why position and velocity are not given over the whole time.
std::string rounding_reason(const Outcome& o) {
  std::string text =
      "free inertial height is unstable, and what arithmetic rounds grows as e^(t / 570 s): from then on it may be "
      "larger than the error that is asked for";
  if (!std::isfinite(o.held.rounding_m)) return text;
  char at_the_end[40];
  std::snprintf(at_the_end, sizeof at_the_end, ", at the end %.2g m", o.held.rounding_m);
  return text + at_the_end;
}

Json position_json(const fusion::NavErrorStatistics& s) {
  return Json{{"rms_3d_m", or_null(s.position_rms_m)},
              {"rms_e_m", or_null(s.position_rms_enu_m.x())},
              {"rms_n_m", or_null(s.position_rms_enu_m.y())},
              {"rms_u_m", or_null(s.position_rms_enu_m.z())},
              {"velocity_rms_m_s", vector_json(s.velocity_rms_enu_m_s)},
              {"final_error_m", or_null(s.final_error_m)},
              {"final_horizontal_error_m", or_null(s.final_horizontal_m)}};
}

/// Times of the log that no reference state speaks for, before and behind those that are scored.
struct Unscored {
  double before_s = 0.0, behind_s = 0.0;
};
Unscored unscored(const Outcome& o) {
  const ImuSample& first = o.recording.samples.front();
  return {std::max(0.0, o.errors.front().t - (first.t - first.dt_s)),
          std::max(0.0, o.recording.samples.back().t - o.errors.back().t)};
}

Json scored_json(const Outcome& o) {
  if (o.errors.size() < 2) return nullptr;
  const GpsTime week = GpsTime::from_week_sow(o.errors.front().t.week(), 0.0);
  const Unscored left = unscored(o);
  return Json{{"from_sow_s", o.errors.front().t - week},
              {"to_sow_s", o.errors.back().t - week},
              {"duration_s", o.errors.back().t - o.errors.front().t},
              {"unscored_before_s", left.before_s},
              {"unscored_behind_s", left.behind_s}};
}

Json summary_json(const Options& options, const Outcome& o) {
  const fusion::NavErrorStatistics none = fusion::navigation_error_statistics({});
  Json out = position_json(o.holds() ? o.statistics : none);
  out["attitude_rms_deg"] = vector_json(o.statistics.attitude_rms_rad / kDegree);
  out["holds_until_s"] = o.holds() ? Json(nullptr) : Json(o.since_start_s(*o.held.until));
  out["reason"] = o.holds() ? Json(nullptr) : Json(rounding_reason(o));
  out["rounding_m"] = or_null(o.held.rounding_m);
  if (!o.holds()) out["held"] = position_json(o.held_ones);
  out["integrator"] = options.integrator;
  out["gravity"] = o.gravity;
  out["samples"] = o.states.size() - 1;
  out["gaps"] = o.recording.gaps;
  out["compared"] = o.errors.empty() ? 0 : o.errors.size() - 1;
  out["start_sow_s"] = o.states.front().t.sow_s();
  out["duration_s"] = o.states.back().t - o.states.front().t;
  out["scored"] = scored_json(o);
  return out;
}

void append_row(std::string& out, const char* format, auto... values) {
  char row[400];
  std::snprintf(row, sizeof row, format, values...);
  out += row;
}

std::string drift_csv(const Outcome& o) {
  std::string out =
      "t_s,error_e_m,error_n_m,error_u_m,error_ve_m_s,error_vn_m_s,error_vu_m_s,error_roll_deg,error_pitch_deg,"
      "error_yaw_deg\n";
  for (std::size_t k = 0; k < o.errors.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const fusion::NavError& e = o.errors[k];
    const Eigen::Vector3d p = e.position_enu_m, v = e.velocity_enu_m_s, a = e.attitude_rad / kDegree;
    const bool held = k < o.held.count;
    append_row(out, "%.9f,", o.since_start_s(e.t));
    out += held ? "" : ",,,";
    if (held) append_row(out, "%.7f,%.7f,%.7f,", p.x(), p.y(), p.z());
    if (held && v.allFinite()) {
      append_row(out, "%.9f,%.9f,%.9f,", v.x(), v.y(), v.z());
    } else {
      out += ",,,";
    }
    append_row(out, "%.10f,%.10f,%.10f\n", a.x(), a.y(), a.z());
  }
  return out;
}

/// What each gyroscope and accelerometer says by itself, without any navigation: the paper's dead-reckoned "heading" of
/// three orthogonal gyroscopes is the plain integral of each one's rate.
struct PlainIntegrals {
  std::vector<double> t_s;
  std::vector<double> rate_deg_s[3], angle_deg[3];

  explicit PlainIntegrals(const Outcome& o) {
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < o.recording.samples.size(); ++k) {
      if (k % kSamplesPerLook == 0) throw_if_cancelled();
      const ImuSample& s = o.recording.samples[k];
      if (s.t <= o.states.front().t) continue;
      t_s.push_back(s.t - o.states.front().t);
      angle += s.dtheta_U / kDegree;
      for (int i = 0; i < 3; ++i) {
        rate_deg_s[i].push_back(s.dtheta_U[i] / s.dt_s / kDegree);
        angle_deg[i].push_back(angle[i]);
      }
    }
  }
};

std::string heading_csv(const Outcome& o, const PlainIntegrals& plain) {
  std::string out = "t_s,roll_deg,pitch_deg,heading_deg,angle_x_deg,angle_y_deg,angle_z_deg\n";
  for (std::size_t k = 0; k < plain.t_s.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const fusion::NavState& s = o.states[k + 1];
    const NedAttitude a = ned_attitude(geodetic_from_ecef(s.p_EU_E), s.R_EU);
    append_row(out, "%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", plain.t_s[k], a.roll_rad / kDegree, a.pitch_rad / kDegree,
               a.heading_rad / kDegree, plain.angle_deg[0][k], plain.angle_deg[1][k], plain.angle_deg[2][k]);
  }
  return out;
}

std::string plot_svg(const Options& options, const Outcome& o, const PlainIntegrals& plain) {
  using report::TimePanel;
  const char* const axes[3] = {"x", "y", "z"};
  TimePanel rates{"Angular rate (as the paper's figure 2)", "deg/s", {}};
  TimePanel angles{"Integral of each gyroscope (as figures 3 and 7)", "deg", {}};
  for (int i = 0; i < 3; ++i) {
    rates.curves.push_back({axes[i], plain.t_s, plain.rate_deg_s[i]});
    angles.curves.push_back({axes[i], plain.t_s, plain.angle_deg[i]});
  }
  std::vector<TimePanel> panels = {rates, angles};
  if (!o.errors.empty()) {
    TimePanel attitude{"Attitude error", "deg", {{"roll", {}, {}}, {"pitch", {}, {}}, {"yaw", {}, {}}}};
    TimePanel position{"Position error (as figure 7)", "m", {{"east", {}, {}}, {"north", {}, {}}, {"up", {}, {}}}};
    for (std::size_t k = 0; k < o.errors.size(); ++k) {
      if (k % kSamplesPerLook == 0) throw_if_cancelled();
      const fusion::NavError& e = o.errors[k];
      for (int i = 0; i < 3; ++i) {
        const auto u = static_cast<std::size_t>(i);
        for (TimePanel* panel : {&attitude, &position}) panel->curves[u].t_s.push_back(o.since_start_s(e.t));
        attitude.curves[u].y.push_back(e.attitude_rad[i] / kDegree);
        position.curves[u].y.push_back(k < o.held.count ? e.position_enu_m[i] : kNaN);
      }
    }
    panels.push_back(attitude);
    panels.push_back(position);
  }
  return report::time_plot_svg(
      "Dead reckoning of " + std::filesystem::path(options.imu).filename().string() + ", " + options.integrator,
      panels);
}

Status write_output(const Options& options, const Outcome& o) {
  if (options.out.empty()) return Ok{};
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  const std::string folder = staged.staging_path() + "/";
  const PlainIntegrals plain(o);
  NavigationFile path;
  path.gravity = o.gravity;
  for (const fusion::NavState& s : o.states) path.records.push_back({s.t, {s.R_EU, s.p_EU_E}, s.v_EU_E});
  CANYON_TRY_STATUS(write_navigation_file(folder + "estimate.nav", path));
  CANYON_TRY_STATUS(write_text_file(folder + "heading.csv", heading_csv(o, plain)));
  if (!o.errors.empty()) CANYON_TRY_STATUS(write_text_file(folder + "drift.csv", drift_csv(o)));
  CANYON_TRY_STATUS(write_text_file(folder + "drift.svg", plot_svg(options, o, plain)));
  CANYON_TRY_STATUS(write_text_file(folder + "summary.json", summary_json(options, o).dump(2) + "\n"));
  return staged.commit();
}

void tell_scored(const Outcome& o) {
  const Unscored left = unscored(o);
  std::printf("  scored from %s at %zu instants", of_week(o.errors.front().t, o.errors.back().t).c_str(),
              o.errors.size() - 1);
  if (left.before_s > fusion::kSameInstant_s || left.behind_s > fusion::kSameInstant_s)
    std::printf("; of the log %.3f s before and %.3f s behind are not", left.before_s, left.behind_s);
  std::printf("\n");
}

void tell(const Options& options, const Outcome& o) {
  std::printf("%s: %zu samples, %.3f s from %.3f s of the week; %s, gravity %s\n", options.imu.c_str(),
              o.states.size() - 1, o.states.back().t - o.states.front().t, o.states.front().t.sow_s(),
              options.integrator.c_str(), o.gravity.c_str());
  if (o.errors.size() < 2) {
    const Geodetic at = geodetic_from_ecef(o.states.back().p_EU_E);
    std::printf("  at the end: %.9f, %.9f deg, %.3f m\n", at.lat_rad / kDegree, at.lon_rad / kDegree, at.h_m);
    if (!(o.held.rounding_m <= fusion::kReferenceTells_m))
      std::printf("  of it rounding alone, which grows as e^(t / 570 s), may be %.2g m\n", o.held.rounding_m);
    return;
  }
  tell_scored(o);
  if (!o.holds())
    std::printf("  position and velocity hold until %.6g s; %s. Up to there:\n", o.since_start_s(*o.held.until),
                rounding_reason(o).c_str());
  const auto& s = o.held_ones;
  const auto row = [](const char* what, const Eigen::Vector3d& v, const char* unit) {
    std::printf("  %-32s %12.6g %12.6g %12.6g %s\n", what, v.x(), v.y(), v.z(), unit);
  };
  row("position RMS, east north up", s.position_rms_enu_m, "m");
  row("velocity RMS, east north up", s.velocity_rms_enu_m_s, "m/s");
  if (o.holds()) row("attitude RMS, roll pitch yaw", o.statistics.attitude_rms_rad / kDegree, "deg");
  row(o.holds() ? "at the end, east north up" : "at that time, east north up", o.held_errors().back().position_enu_m,
      "m");
  std::printf("  %s error %.6g m, of it horizontal %.6g m\n", o.holds() ? "final" : "then", s.final_error_m,
              s.final_horizontal_m);
  if (!o.holds()) row("attitude RMS of all the time", o.statistics.attitude_rms_rad / kDegree, "deg");
}

Result<Reference> reference_of(const Options& options, const NavigationFile& truth,
                               const std::vector<ImuSample>& samples) {
  if (!options.initial.empty()) return from_initial(options, samples);
  if (!options.at_rest.empty()) return from_rest(options, samples);
  Reference out;
  out.gravity = truth.gravity;
  std::vector<fusion::NavState> states;
  for (const NavigationRecord& record : truth.records) states.push_back(state_of(record));
  CANYON_TRY(out.initial, start_in_truth(states, samples, options));
  if (!out.initial.v_EU_E.allFinite())
    return Error{options.truth, 0, "", "has no velocity to start from", "columns vn,ve,vd"};
  out.truth = fusion::reference_from(out.initial, states);
  return out;
}

Status check_name(const std::string& option, const std::string& name, const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& one : known) {
    if (one == name) return Ok{};
    list += (list.empty() ? "one of " : ", ") + one;
  }
  return Error{option, 0, "", "\"" + name + "\"", list};
}

/// The gravity that the truth file states must be one that we have.
Status check_stated_gravity(const Options& options, const NavigationFile& truth) {
  const std::vector<std::string> known = gravity_names();
  if (truth.gravity.empty() || std::find(known.begin(), known.end(), truth.gravity) != known.end()) return Ok{};
  const std::string nearest = nearest_word(truth.gravity, known);
  return Error{
      options.truth, truth.gravity_line, "# gravity", "unknown name \"" + truth.gravity + "\"",
      "one of " + quoted_list(known) + ", or --gravity" + (nearest.empty() ? "" : "; nearest is \"" + nearest + "\"")};
}

Result<int> run(const Options& options) {
  CANYON_TRY_STATUS(check_name("--integrator", options.integrator, fusion::strapdown_names()));
  if (!options.gravity.empty()) CANYON_TRY_STATUS(check_name("--gravity", options.gravity, gravity_names()));
  CANYON_TRY_STATUS(check_name("--axes", options.axes, {"flu", "frd"}));
  set_threads(options.common.threads);
  NavigationFile truth;
  if (!options.truth.empty()) {
    CANYON_TRY(truth, read_navigation_file(options.truth));
  }
  Outcome o;
  CANYON_TRY(o.recording, read_imu(options, truth.records.empty() ? 0 : truth.records.front().t.week()));
  CANYON_TRY(o.reference, reference_of(options, truth, o.recording.samples));
  CANYON_TRY_STATUS(check_axes(options, o.recording.samples, o.reference.initial));
  if (options.gravity.empty()) CANYON_TRY_STATUS(check_stated_gravity(options, truth));
  o.gravity = !options.gravity.empty()       ? options.gravity
              : !o.reference.gravity.empty() ? o.reference.gravity
              : o.recording.kf_gins          ? "grs80_series"
                                             : "wgs84";
  const auto strapdown = fusion::make_strapdown(options.integrator, gravity_by_name(o.gravity));
  o.states = fusion::dead_reckon(o.recording.samples, o.reference.initial, *strapdown);
  o.errors = fusion::navigation_errors(o.states, o.reference.truth);
  o.held = fusion::held_errors(o.states, o.errors);
  o.statistics = fusion::navigation_error_statistics(o.errors);
  o.held_ones = fusion::navigation_error_statistics(o.held_errors());
  CANYON_TRY_STATUS(write_output(options, o));
  if (options.common.json)
    std::printf("%s\n", summary_json(options, o).dump().c_str());
  else
    tell(options, o);
  return 0;
}

std::string integrators_help() {
  std::string out = "strapdown model:";
  for (const fusion::StrapdownRow& row : fusion::strapdown_models())
    out += std::string("\n") + row.name + ", order " + std::to_string(row.order) + ": " + row.doc;
  return out;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments
      .option("--imu", options->imu,
              "the log: CSV of rates (header t_s,gx_rad_s,...,az_m_s2; the mean over the interval that ends at t_s), "
              "or KF-GINS text of increments (sow, rad, m/s; forward-right-down)")
      .required();
  arguments.option("--columns", options->columns, "column names or layout of the log, as for imu allan");
  const auto truth = arguments.option("--truth", options->truth,
                                      "reference to start from and compare with: KF-GINS text, or CSV with "
                                      "sow,lat_deg,lon_deg,h_m,vn,ve,vd,roll_deg,pitch_deg,heading_deg");
  const auto initial =
      arguments.option("--initial", options->initial,
                       "LAT,LON,H,VN,VE,VD,ROLL,PITCH,HEADING at the log's first stamp: degrees, metres, m/s");
  const auto rest =
      arguments.option("--static", options->at_rest,
                       "LAT,LON,H,HEADING of a log at rest: levelled with its own first seconds, compared with "
                       "standing still");
  truth.excludes(initial).excludes(rest);
  initial.excludes(rest);
  arguments.option("--level", options->level_s, "seconds that --static takes for levelling")
      .default_shown()
      .within(0.0, 1e6);
  arguments.option("--integrator", options->integrator, integrators_help()).default_shown();
  arguments.option(
      "--gravity", options->gravity,
      "wgs84 or grs80_series; default: what the truth file states, else that of KF-GINS (grs80_series) for "
      "its text format and wgs84 for CSV");
  arguments.option("--axes", options->axes, "axes of a CSV log: flu (forward-left-up) or frd").default_shown();
  arguments.option("--out", options->out,
                   "directory for estimate.nav, heading.csv, drift.csv, drift.svg and summary.json");
  arguments.flag("--force", options->force,
                 "replace the directory if it exists; only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> {
    if (options->truth.empty() && options->initial.empty() && options->at_rest.empty())
      return Error{"", 0, "command line", "no start given", "--truth FILE, --initial ... or --static ..."};
    return run(*options);
  };
}

}  // namespace

Verb imu_dead_reckon_verb() {
  return {"imu dead-reckon", "free inertial navigation on a log, and how it drifts",
          "canyon imu dead-reckon --imu imu.csv --truth truth.nav --out drift", declare};
}

}  // namespace canyon::apps
