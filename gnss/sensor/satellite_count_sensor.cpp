#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

constexpr int kFewest = 4, kMany = 12;

/// Three sigmas per axis.
struct SatelliteCountParameters {
  double noise_max_m = 10.0;  ///< with four satellites
  double noise_min_m = 2.0;   ///< with twelve or more
};
void visit(FieldVisitor& f, SatelliteCountParameters& c) {
  f.number("count_noise_max_m", c.noise_max_m, {0.0, 1e4},
           "satellite_count: three sigmas per axis with four satellites");
  f.number("count_noise_min_m", c.noise_min_m, {0.0, 1e4}, "satellite_count: the same with twelve or more");
}

/// Balaguer & Carpin (2008), "Where am I? A simulated GPS sensor for outdoor robotic applications", as their receiver
/// stands in USARSim (class GPSSensor, NIST, public domain): satellites above 5 deg (here mask_deg) that a ray to the
/// sky finds unblocked are counted. Fewer than four: no fix. Else each axis errs by independent Gaussian noise, three
/// sigmas of which fall linearly from count_noise_max_m with four satellites to count_noise_min_m with twelve (and stay
/// there). Where the satellites stand makes no difference, so there is no DOP, and no multipath. Theirs errs in
/// latitude and longitude only, for it has no height; here all three axes do.
class SatelliteCountSensor final : public GnssSensor {
 public:
  SatelliteCountSensor(const SatelliteCountParameters& config, double mask_rad, std::uint64_t seed,
                       const LocalFrame& frame, SatelliteSource source)
      : config_(config),
        mask_rad_(mask_rad),
        frame_(frame),
        source_(std::move(source)),
        visibility_(make_visibility({})),
        noise_(seed, "gnss.satellite_count") {}

  GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                     const scene::SceneAt& scene) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    CANYON_CHECK(p_A_W.allFinite() && v_A_W.allFinite(), "antenna at ", p_A_W.transpose(), ", velocity ",
                 v_A_W.transpose());
    ++counters_.epochs;
    GnssOutput out;
    out.epoch.t = out.truth.t = out.fix.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    out.truth.v_A_E = frame_.R_EW() * v_A_W;
    const int satellites = count(out.truth, p_A_W, scene);
    if (satellites < kFewest) {
      out.fix.reason = std::to_string(satellites) + (satellites == 1 ? " satellite" : " satellites") +
                       ", a fix needs " + std::to_string(kFewest);
      return out;
    }
    const double share = static_cast<double>(std::min(satellites, kMany) - kFewest) / (kMany - kFewest);
    const double sigma_m = (config_.noise_max_m + share * (config_.noise_min_m - config_.noise_max_m)) / 3.0;
    out.fix.status = FixStatus::kSingle;
    out.fix.satellites = satellites;
    out.fix.p_A_E = out.truth.p_A_E + frame_.R_EW() * (sigma_m * noise_.normal3(static_cast<std::uint64_t>(index)));
    const double claimed_m = std::max(sigma_m, kLeastClaimed_m);
    out.fix.covariance_E = claimed_m * claimed_m * Eigen::Matrix3d::Identity();
    out.fix.dop = dilution(out.truth);
    return out;
  }

  GnssCounters counters() const override { return counters_; }
  bool has_satellites() const override { return true; }
  std::vector<std::string> warnings() const override { return source_.warnings; }

 private:
  /// Of the satellites in sight, for whoever reads it: the noise does not.
  static Dop dilution(const GnssTruth& truth) {
    const Eigen::Matrix3d R_E_enu = Horizon(truth.p_A_E).R_E_enu();
    std::vector<Eigen::Vector3d> lines_E;
    std::vector<GnssSystem> systems;
    for (const GnssObservationTruth& s : truth.satellites) {
      if (!s.line_of_sight) continue;
      const double level = std::cos(s.elevation_rad);
      lines_E.push_back(R_E_enu * Eigen::Vector3d(level * std::sin(s.azimuth_rad), level * std::cos(s.azimuth_rad),
                                                  std::sin(s.elevation_rad)));
      systems.push_back(s.sv.system);
    }
    return dilution_of_precision(lines_E, systems, R_E_enu);
  }

  /// Fills in the truth records of the satellites above the mask; the number of those in sight.
  int count(GnssTruth& truth, const Eigen::Vector3d& p_A_W, const scene::SceneAt& scene) {
    const Horizon horizon(truth.p_A_E);
    std::vector<Eigen::Vector3d> directions_W;
    for (const SatelliteId sv : source_.constellation->satellites()) {
      const auto signal = transmission_to(*source_.constellation, sv, truth.t, truth.p_A_E);
      if (!signal) continue;
      const SkyView view = horizon.view(truth.t, signal->p_E());
      if (view.elevation_rad < mask_rad_) continue;
      GnssObservationTruth s;
      s.sv = sv;
      s.elevation_rad = view.elevation_rad;
      s.azimuth_rad = view.azimuth_rad;
      s.range_m = signal->range_m;
      truth.satellites.push_back(s);
      directions_W.push_back(frame_.R_EW().transpose() * (signal->p_E() - truth.p_A_E).normalized());
    }
    std::vector<SignalPaths> paths(directions_W.size());
    visibility_->trace(p_A_W, directions_W, scene, paths, counters_);
    int in_sight = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      truth.satellites[i].line_of_sight = truth.satellites[i].tracked = paths[i].line_of_sight;
      in_sight += paths[i].line_of_sight ? 1 : 0;
    }
    return in_sight;
  }

  SatelliteCountParameters config_;
  double mask_rad_;
  LocalFrame frame_;
  SatelliteSource source_;
  std::unique_ptr<PathModel> visibility_;
  RandomStream noise_;
  GnssCounters counters_;
};

}  // namespace

void satellite_count_parameters(ModelParameters& section) {
  section.add<SatelliteCountParameters>();
}

Result<std::unique_ptr<GnssSensor>> make_satellite_count_sensor(const ModelParameters& own, const SensorSetup& at) {
  const auto& p = own.get<SatelliteCountParameters>();
  if (p.noise_max_m < p.noise_min_m)
    return Error{"", 0, "gnss.count_noise_max_m", "is " + join_values(p.noise_max_m),
                 "at least gnss.count_noise_min_m = " + join_values(p.noise_min_m)};
  CANYON_TRY(SatelliteSource source, make_satellite_source(at.config.satellites, at.start, at.end));
  return std::unique_ptr<GnssSensor>(std::make_unique<SatelliteCountSensor>(
      p, at.config.mask_deg * kDegree, at.noise_seed, at.scene.frame(), std::move(source)));
}

}  // namespace canyon::gnss
