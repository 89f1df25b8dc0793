#pragma once

#include "canyon/study/tradeoff/probes/probe.h"

/// Makers of the rows of the table in probes.cpp, each in the file of its part.
namespace canyon::study {

Result<std::unique_ptr<Probe>> make_pseudorange_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_fix_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_fix_sequence_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_orbit_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_free_inertial_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_proof_mass_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_range_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_object_range_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_filter_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_smooth_position_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_smooth_velocity_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_smooth_attitude_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_keyframe_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_mission_map_probe(const ProbeSetup& setup);

// On a recorded drive (study/tradeoff/recorded/).
Result<std::unique_ptr<Probe>> make_recorded_pseudorange_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_recorded_strength_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_recorded_fix_probe(const ProbeSetup& setup);
Result<std::unique_ptr<Probe>> make_recorded_orbit_probe(const ProbeSetup& setup);

/// Orders of the rows that a ladder is of.
using ProbeSettings = std::map<std::string, std::string>;
std::optional<double> position_order(const ProbeSettings& own, const mission::MissionConfig& config);
std::optional<double> velocity_order(const ProbeSettings& own, const mission::MissionConfig& config);
std::optional<double> attitude_order(const ProbeSettings& own, const mission::MissionConfig& config);
std::optional<double> proof_mass_order(const ProbeSettings& own, const mission::MissionConfig& config);

}  // namespace canyon::study
