#include "canyon/gnss/sensor/pseudorange_parts.h"

#include <algorithm>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/sensor/satellite_source.h"
#include "canyon/gnss/solver/fault_exclusion.h"

namespace canyon::gnss {
namespace {

/// The row of a ladder that the configuration names.
template <class Make>
Result<const ModelRow<Make>*> choose(std::span<const ModelRow<Make>> rows, const char* key, const std::string& name) {
  if (const auto* row = find_model(rows, name)) return row;
  std::string all;
  for (const auto& n : model_names(rows)) all += (all.empty() ? "" : ", ") + n;
  return Error{"", 0, std::string("gnss.") + key, "\"" + name + "\" is not a model", all};
}

CorrelatorDesign correlator_design(const GnssConfig& c, Modulation modulation) {
  CorrelatorDesign d;
  d.modulation = modulation;
  d.spacing_chips = c.correlator_spacing_chips;
  d.double_delta = c.correlator == "double_delta";
  d.coherent = c.discriminator == "coherent";
  // A channel is given at least the main lobes of its signal.
  const double lobes_hz = (modulation == Modulation::kBoc11 ? 4.0 : 2.0) * chip_rate_hz(modulation);
  if (c.front_end_mhz > 0.0) d.front_end_hz = std::max(1e6 * c.front_end_mhz, lobes_hz);
  d.code_loop_hz = c.code_loop_hz;
  d.carrier_loop_hz = c.carrier_loop_hz;
  d.integration_s = 1e-3 * c.integration_ms;
  return d;
}

/// What the receiver can notice of the ways that a signal takes.
PathParameters path_parameters(const GnssConfig& c) {
  PathParameters p;
  // A correlator sees reflections until their peak leaves its late arm; BPSK(1) has the longest chip.
  p.cutoff_m = c.multipath_rule == "paper_first_return" ? c.cutoff_ns * 1e-9 * kSpeedOfLight
                                                        : (1.0 + 0.5 * c.correlator_spacing_chips) * kCaChipM;
  p.weakest_nlos_db = c.tracking_threshold_dbhz - c.cn0_zenith_dbhz;
  p.weakest_db = std::min(p.weakest_db, p.weakest_nlos_db);
  p.roughness_m = c.surface_roughness_m;
  return p;
}

/// The orbits that broadcast_minus_sp3 compares with.
Result<std::shared_ptr<const Constellation>> make_precise_source(const GnssConfig& c, const SatelliteSource& source,
                                                                 std::vector<std::string>& warnings) {
  if (!source.navigation.has_ephemeris())
    return Error{"", 0, "gnss.ephemeris_error", "is \"broadcast_minus_sp3\", but there is no broadcast",
                 "gnss.nav_file"};
  if (c.sp3_files.empty())
    return Error{"", 0, "gnss.ephemeris_error", "is \"broadcast_minus_sp3\", but there are no precise orbits",
                 "gnss.sp3_files"};
  CANYON_TRY(const PreciseOrbits orbits, read_sp3_files(c.sp3_files));
  warnings.insert(warnings.end(), orbits.warnings.begin(), orbits.warnings.end());
  AntexFile antennas;
  PreciseOptions options;
  options.systems = c.systems;
  if (!c.antex_file.empty()) {
    CANYON_TRY(antennas, read_antex_file(c.antex_file));
    warnings.insert(warnings.end(), antennas.warnings.begin(), antennas.warnings.end());
    options.antennas = &antennas;
  }
  return std::shared_ptr<const Constellation>(make_precise(orbits, options));
}

Result<std::shared_ptr<const IonexMaps>> read_maps(const GnssConfig& c, GpsTime start, GpsTime end,
                                                   std::vector<std::string>& warnings) {
  if (c.ionex_file.empty())
    return Error{"", 0, "gnss.ionosphere", "is \"ionex\", but there are no maps", "gnss.ionex_file"};
  CANYON_TRY(IonexMaps maps, read_ionex_file(c.ionex_file));
  if (start < maps.maps.front().t || end > maps.maps.back().t)
    return Error{c.ionex_file, 0, "gnss.ionex_file",
                 "covers " + maps.maps.front().t.iso(0) + " to " + maps.maps.back().t.iso(0) + " GPS time, not " +
                     start.iso(0) + " to " + end.iso(0),
                 "maps of that time"};
  warnings.insert(warnings.end(), maps.warnings.begin(), maps.warnings.end());
  return std::make_shared<const IonexMaps>(std::move(maps));
}

}  // namespace

int second_band(GnssSystem system, const std::string& second_frequency) {
  const bool l5 = second_frequency == "L5";
  switch (system) {
    case GnssSystem::kGlonass:
      return 2;
    case GnssSystem::kGalileo:
      return l5 ? 5 : 7;
    case GnssSystem::kBeidou:
      return l5 ? 5 : 6;  // B3I: only BeiDou-2 sends B2I
    case GnssSystem::kGps:
    case GnssSystem::kQzss:
    case GnssSystem::kSbas:
      break;
  }
  return l5 || system == GnssSystem::kSbas ? 5 : 2;
}

Result<PseudorangeParts> make_pseudorange_parts(const GnssConfig& c, std::uint64_t seed, GpsTime start, GpsTime end) {
  CANYON_TRY(const auto* ionosphere, choose(ionosphere_models(), "ionosphere", c.ionosphere));
  CANYON_TRY(const auto* troposphere, choose(troposphere_models(), "troposphere", c.troposphere));
  CANYON_TRY(const auto* ephemeris_error, choose(ephemeris_error_models(), "ephemeris_error", c.ephemeris_error));
  CANYON_TRY(const auto* paths, choose(path_models(), "paths", c.paths));
  CANYON_TRY(const auto* diffraction, choose(diffraction_models(), "diffraction", c.diffraction));
  CANYON_TRY(const auto* multipath, choose(multipath_rules(), "multipath_rule", c.multipath_rule));
  CANYON_TRY(const auto* antenna, choose(antenna_models(), "antenna", c.antenna));
  CANYON_TRY(const auto* clock, choose(receiver_clock_models(), "receiver_clock", c.receiver_clock));
  CANYON_TRY(const auto* mode, choose(receiver_modes(), "mode", c.mode));
  CANYON_TRY(const auto* solver, choose(position_solvers(), "solver", c.solver));

  CANYON_TRY(const auto* weighting, choose(range_weightings(), "weighting", c.weighting));
  CANYON_TRY(const auto* raim, choose(fault_exclusions(), "raim", c.raim));

  PseudorangeParts parts;
  CANYON_TRY(SatelliteSource source, make_satellite_source(c, start, end));
  const KlobucharCoefficients klobuchar = source.klobuchar;
  parts.warnings = source.warnings;
  parts.constellation = std::move(source.constellation);
  IonosphereParameters ionosphere_parameters{c.vtec_tecu, klobuchar, {}};
  if (c.ionosphere == "ionex") {
    CANYON_TRY(ionosphere_parameters.maps, read_maps(c, start, end, parts.warnings));
  }
  parts.ionosphere = ionosphere->make(ionosphere_parameters);
  parts.troposphere = troposphere->make({{c.pressure_hpa, c.temperature_c, c.relative_humidity}, c.weather_height_m});
  EphemerisErrorParameters orbit{seed, c.ephemeris_sigma_m, c.ephemeris_tau_s, parts.constellation, {}};
  if (c.ephemeris_error == "broadcast_minus_sp3") {
    CANYON_TRY(orbit.precise, make_precise_source(c, source, parts.warnings));
  }
  parts.ephemeris_error = ephemeris_error->make(orbit);
  const PathParameters path_limits = path_parameters(c);
  parts.paths = paths->make(path_limits);
  if (c.diffraction != "none" || c.ground_reflection)
    parts.paths =
        make_propagation(std::move(parts.paths), diffraction->make(path_limits), c.ground_reflection, path_limits);
  for (std::size_t i = 0; i < kModulations; ++i) {
    const CorrelatorDesign design = correlator_design(c, static_cast<Modulation>(i));
    parts.channels[i].multipath =
        multipath->make({c.cutoff_ns * 1e-9 * kSpeedOfLight, c.tracking_threshold_dbhz, design});
    parts.channels[i].tracking = std::make_unique<CodeTracking>(design);
  }
  parts.clock = clock->make({seed, 1.0 / c.rate_hz});
  parts.mode = mode->make({seed, c.ionosphere != "none", c.troposphere != "none", c.ionosphere_correction, klobuchar,
                           c.baseline_km, c.ionosphere_gradient_mm_per_km, c.troposphere_gradient_mm_per_km,
                           c.base_error_scale});
  PositionSolverParameters solver_parameters;
  solver_parameters.max_gdop = c.max_gdop;
  solver_parameters.fault_exclusion = raim->name;
  solver_parameters.false_alarm = c.raim_false_alarm;
  parts.solver = solver->make(solver_parameters);
  parts.weighting = weighting->make({c.solver_sigma_m});
  parts.link.cn0_zenith_dbhz = c.cn0_zenith_dbhz;
  parts.link.foliage_db_per_m = c.foliage_db_per_m;
  parts.link.foliage_max_db = c.foliage_max_db;
  parts.link.antenna = antenna->make({c.antenna_horizon_loss_db, c.lhcp_rejection_db});
  parts.locks.seed = seed;
  parts.locks.interval_s = 1.0 / c.rate_hz;
  parts.locks.threshold_dbhz = c.tracking_threshold_dbhz;
  parts.locks.reacquisition_margin_db = c.reacquisition_margin_db;
  parts.locks.reacquisition_s = c.reacquisition_s;
  parts.locks.carrier_loop_hz = c.carrier_loop_hz;
  parts.locks.integration_s = 1e-3 * c.integration_ms;
  parts.locks.slips = c.thermal_noise_scale > 0.0;
  if (!parts.solver->solves_clock() && c.receiver_clock != "none")
    return Error{"", 0, "gnss.receiver_clock",
                 "is \"" + c.receiver_clock + "\", but solver \"" + c.solver + "\" has no unknown for it", "\"none\""};
  return parts;
}

}  // namespace canyon::gnss
