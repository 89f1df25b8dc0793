#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/glonass_channels.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kPoints = 10;  // of the polynomial

/// Samples without a gap or manoeuvre between them: [begin, end) of a satellite's samples.
struct Run {
  std::size_t begin, end;
};

struct Track {
  std::vector<PreciseSample> samples;
  std::vector<Run> runs;
  std::vector<Antenna> antennas;
  std::array<double, 10> group_delay_s{};
  unsigned borrowed_delay_bands = 0;
  int frequency_channel = 0;
};

struct Motion {
  Eigen::Vector3d p_E, v_E;
};

/// Neville's scheme at t for values and derivative at once.
Motion interpolated(const PreciseSample* samples, GpsTime t, double earth_rate_rad_s) {
  std::array<double, kPoints> x;
  std::array<Eigen::Vector3d, kPoints> p, v;
  for (std::size_t i = 0; i < kPoints; ++i) {
    x[i] = samples[i].t - t;
    const double c = std::cos(earth_rate_rad_s * x[i]), s = std::sin(earth_rate_rad_s * x[i]);
    const Eigen::Vector3d& q = samples[i].p_E;
    p[i] = {c * q.x() - s * q.y(), s * q.x() + c * q.y(), q.z()};
    v[i] = Eigen::Vector3d::Zero();
  }
  for (std::size_t k = 1; k < kPoints; ++k)
    for (std::size_t i = 0; i + k < kPoints; ++i) {
      const double span = x[i] - x[i + k];
      v[i] = (-x[i + k] * v[i] + p[i] + x[i] * v[i + 1] - p[i + 1]) / span;
      p[i] = (-x[i + k] * p[i] + x[i] * p[i + 1]) / span;
    }
  return {p[0], v[0] + earth_rate_rad_s * Eigen::Vector3d(p[0].y(), -p[0].x(), 0.0)};
}

/// Broadcast delays by band against the combination that precise clocks refer to, instead of against the broadcast's
/// own clock; nullopt for messages that give none of use here.
std::optional<std::array<double, 10>> delays_for_precise_clock(const KeplerEphemeris& r) {
  std::array<double, 10> out = r.group_delay_s();
  const double datum_s = delay_of_precise_clock_s(r.sv.system, out);
  const auto known = [&](std::initializer_list<std::size_t> bands) {
    for (const std::size_t band : bands) out[band] -= datum_s;
    return out;
  };
  switch (r.message) {
    case NavigationMessage::kLnav:
      return known({1, 2});
    case NavigationMessage::kFnav:
      return known({1, 5});
    case NavigationMessage::kInav:
      return known({1, 5, 7});
    case NavigationMessage::kD1:
    case NavigationMessage::kD2:
      return known({1, 2, 6, 7});
    default:
      return std::nullopt;
  }
}

/// By slot; what is nearer to the observations counts.
std::map<int, int> glonass_channels(const PreciseOptions& options) {
  std::map<int, int> channels = options.glonass_channels;
  if (options.broadcast != nullptr)
    for (const auto& r : options.broadcast->glonass) channels.emplace(r.sv.prn, r.frequency_channel);
  channels.merge(glonass_channel_plan());
  return channels;
}

class Precise final : public Constellation {
 public:
  Precise(const PreciseOrbits& orbits, const PreciseOptions& options) : interval_s_(orbits.interval_s) {
    for (const char letter : options.systems)
      CANYON_CHECK(std::string_view("GRECJ").find(letter) != std::string_view::npos, "system ", letter);
    if (options.clocks != nullptr) clocks_ = *options.clocks;
    for (const auto& [sv, samples] : orbits.satellites) {
      if (options.systems.find(system_letter(sv.system)) == std::string::npos) continue;
      Track track{samples, runs_of(samples), {}, {}, 0, 0};
      if (options.antennas != nullptr)
        for (const auto& antenna : options.antennas->antennas)
          if (antenna.sv == sv) track.antennas.push_back(antenna);
      tracks_.emplace(sv, std::move(track));
      satellites_.push_back(sv);
    }
    if (options.broadcast != nullptr)
      for (const auto& r : options.broadcast->kepler) {
        const auto found = tracks_.find(r.sv);
        const auto delays = delays_for_precise_clock(r);
        if (found == tracks_.end() || !delays) continue;
        found->second.group_delay_s = *delays;
        found->second.borrowed_delay_bands = r.borrowed_delay_bands();
      }
    const std::map<int, int> channels = glonass_channels(options);
    for (auto& [sv, track] : tracks_) {
      if (sv.system != GnssSystem::kGlonass) continue;
      const auto known = channels.find(sv.prn);
      track.frequency_channel = known == channels.end() ? kUnknownChannel : known->second;
    }
  }

  const std::vector<SatelliteId>& satellites() const override { return satellites_; }

  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    const auto found = tracks_.find(sv);
    if (found == tracks_.end()) return std::nullopt;
    const Track& track = found->second;
    const Run* run = run_at(track, t);
    if (run == nullptr) return std::nullopt;
    const auto clock = clocks_ ? clock_of_file(sv, t) : clock_of_samples(track, *run, t);
    if (!clock) return std::nullopt;

    const std::size_t after = first_after(track, *run, t);
    const std::size_t half = kPoints / 2;
    const std::size_t begin = std::min(std::max(after, run->begin + half) - half, run->end - kPoints);
    const Motion m = interpolated(&track.samples[begin], t, constants_of(GnssSystem::kGps).earth_rate_rad_s);

    SatelliteState s;
    s.p_E = m.p_E;
    s.v_E = m.v_E;
    // Periodic relativity, and its derivative on a Kepler orbit.
    const SystemConstants& earth = constants_of(GnssSystem::kGps);
    const Eigen::Vector3d v_inertial = m.v_E + earth.earth_rate_rad_s * Eigen::Vector3d::UnitZ().cross(m.p_E);
    constexpr double kPerC2 = -2.0 / (kSpeedOfLight * kSpeedOfLight);
    s.clock_s = clock->value + kPerC2 * m.p_E.dot(m.v_E);
    s.clock_rate = clock->rate + kPerC2 * (v_inertial.squaredNorm() - earth.mu_m3_s2 / m.p_E.norm());
    s.group_delay_s = track.group_delay_s;
    s.borrowed_delay_bands = track.borrowed_delay_bands;
    s.frequency_channel = track.frequency_channel;
    for (const auto& antenna : track.antennas)
      if ((!antenna.valid_from || t >= *antenna.valid_from) && (!antenna.valid_to || t <= *antenna.valid_to)) {
        s.p_E += satellite_offset_E(antenna, m.p_E, t);
        break;
      }
    return s;
  }

 private:
  struct Clock {
    double value, rate;
  };

  std::vector<Run> runs_of(const std::vector<PreciseSample>& samples) const {
    std::vector<Run> runs;
    for (std::size_t i = 0, begin = 0; i < samples.size(); ++i) {
      const bool last = i + 1 == samples.size();
      if (!last && samples[i + 1].t - samples[i].t < 1.5 * interval_s_ && !samples[i + 1].manoeuvre) continue;
      if (i + 1 - begin >= kPoints) runs.push_back({begin, i + 1});
      begin = i + 1;
    }
    return runs;
  }

  const Run* run_at(const Track& track, GpsTime t) const {
    for (const Run& run : track.runs)
      if (t - track.samples[run.begin].t >= -0.5 * interval_s_ && t - track.samples[run.end - 1].t <= 0.5 * interval_s_)
        return &run;
    return nullptr;
  }

  /// First sample of the run later than t.
  static std::size_t first_after(const Track& track, const Run& run, GpsTime t) {
    const auto begin = track.samples.begin() + static_cast<std::ptrdiff_t>(run.begin),
               end = track.samples.begin() + static_cast<std::ptrdiff_t>(run.end);
    return static_cast<std::size_t>(
        std::upper_bound(begin, end, t, [](GpsTime time, const PreciseSample& s) { return time < s.t; }) -
        track.samples.begin());
  }

  /// On the line through the two samples around t; outside the run on that through its first or last two.
  static std::optional<Clock> clock_of_samples(const Track& track, const Run& run, GpsTime t) {
    const std::size_t after = std::clamp(first_after(track, run, t), run.begin + 1, run.end - 1);
    const PreciseSample &a = track.samples[after - 1], &b = track.samples[after];
    if (a.t == t && !std::isnan(a.clock_s) && (std::isnan(b.clock_s) || b.clock_event)) return Clock{a.clock_s, 0.0};
    if (std::isnan(a.clock_s) || std::isnan(b.clock_s) || b.clock_event) return std::nullopt;
    const double rate = (b.clock_s - a.clock_s) / (b.t - a.t);
    return Clock{a.clock_s + rate * (t - a.t), rate};
  }

  std::optional<Clock> clock_of_file(SatelliteId sv, GpsTime t) const {
    const double value = clocks_->clock_s(sv, t);
    if (std::isnan(value)) return std::nullopt;
    const double later = clocks_->clock_s(sv, t + 1.0), earlier = clocks_->clock_s(sv, t - 1.0);
    const double rate = !std::isnan(later) ? later - value : !std::isnan(earlier) ? value - earlier : 0.0;
    return Clock{value, rate};
  }

  double interval_s_;
  std::map<SatelliteId, Track> tracks_;
  std::vector<SatelliteId> satellites_;
  std::optional<ClockFile> clocks_;
};

}  // namespace

std::unique_ptr<Constellation> make_precise(const PreciseOrbits& orbits, const PreciseOptions& options) {
  return std::make_unique<Precise>(orbits, options);
}

}  // namespace canyon::gnss
