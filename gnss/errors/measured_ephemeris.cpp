#include <map>
#include <optional>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/math/median.h"
#include "canyon/core/units.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/products/precise_orbits.h"

namespace canyon::gnss {
namespace {

struct PreciseParameters {
  std::vector<std::string> sp3_files;
  std::string antex_file;
};
void visit(FieldVisitor& f, PreciseParameters& c) {
  f.files("sp3_files", c.sp3_files, "ephemeris_error broadcast_minus_sp3: precise orbits and clocks, SP3");
  f.file(
      "antex_file", c.antex_file, "",
      "ephemeris_error broadcast_minus_sp3: ANTEX file with the satellites' antennas; without it their offsets count "
      "as error");
}

/// What the broadcast of the day really erred by: broadcast minus precise orbit and clock. The clocks' difference is
/// taken against its median over the system's satellites, for the two time scales may differ; both clocks refer to the
/// two-frequency combination. Satellites and times that the precise product does not have err by nothing.
class MeasuredEphemeris final : public EphemerisError {
 public:
  MeasuredEphemeris(std::shared_ptr<const Constellation> broadcast, std::shared_ptr<const Constellation> precise)
      : broadcast_(std::move(broadcast)), precise_(std::move(precise)) {
    CANYON_CHECK(broadcast_ && precise_, "broadcast and precise constellation are needed");
  }

  double range_m(SatelliteId sv, const SatelliteState&, const Eigen::Vector3d& receiver_E, GpsTime t) const override {
    const auto it = at(t).find(sv);
    if (it == differences_.end()) return 0.0;
    const Difference& d = it->second;
    return d.clock_m - (d.p_E - receiver_E).normalized().dot(d.orbit_E);
  }

 private:
  struct Difference {
    Eigen::Vector3d p_E, orbit_E;
    double clock_m;
  };

  /// Of all satellites at t; kept until another time is asked for.
  const std::map<SatelliteId, Difference>& at(GpsTime t) const {
    if (time_ == t) return differences_;
    time_ = t;
    differences_.clear();
    std::map<GnssSystem, std::vector<double>> clocks;
    for (const SatelliteId sv : broadcast_->satellites()) {
      const auto b = broadcast_->state(sv, t), p = precise_->state(sv, t);
      if (!b || !p) continue;
      const double broadcast_s = b->clock_s - delay_of_precise_clock_s(sv.system, b->group_delay_s);
      const double clock_m = kSpeedOfLight * (broadcast_s - p->clock_s);
      differences_[sv] = {p->p_E, b->p_E - p->p_E, clock_m};
      clocks[sv.system].push_back(clock_m);
    }
    std::map<GnssSystem, double> common_m;
    for (const auto& [system, values] : clocks) common_m[system] = median(values);
    for (auto& [sv, d] : differences_) d.clock_m -= common_m.at(sv.system);
    return differences_;
  }

  std::shared_ptr<const Constellation> broadcast_, precise_;
  mutable std::optional<GpsTime> time_;
  mutable std::map<SatelliteId, Difference> differences_;
};

}  // namespace

void broadcast_minus_sp3_parameters(ModelParameters& section) {
  section.add<PreciseParameters>();
}

Result<std::unique_ptr<EphemerisError>> make_broadcast_minus_sp3(const ModelParameters& own,
                                                                 const EphemerisErrorSetup& at) {
  const auto& p = own.get<PreciseParameters>();
  if (!at.broadcast)
    return Error{"", 0, "gnss.ephemeris_error", "is \"broadcast_minus_sp3\", but there is no broadcast",
                 "gnss.nav_file"};
  if (p.sp3_files.empty())
    return Error{"", 0, "gnss.ephemeris_error", "is \"broadcast_minus_sp3\", but there are no precise orbits",
                 "gnss.sp3_files"};
  const auto warn = [&at](const std::vector<std::string>& lines) {
    if (at.warnings != nullptr) at.warnings->insert(at.warnings->end(), lines.begin(), lines.end());
  };
  CANYON_TRY(const PreciseOrbits orbits, read_sp3_files(p.sp3_files));
  warn(orbits.warnings);
  AntexFile antennas;
  PreciseOptions options;
  options.systems = at.systems;
  if (!p.antex_file.empty()) {
    CANYON_TRY(antennas, read_antex_file(p.antex_file));
    warn(antennas.warnings);
    options.antennas = &antennas;
  }
  return std::unique_ptr<EphemerisError>(
      std::make_unique<MeasuredEphemeris>(at.satellites, make_precise(orbits, options)));
}

}  // namespace canyon::gnss
