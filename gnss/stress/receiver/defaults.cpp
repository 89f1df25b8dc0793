// Keys that nobody sets.
#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/receiver/signal_lock.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/single_point/config.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

/// Keys that nobody sets, as the manual states them (docs/gnss.md).
StressFigure keys_as_they_come() {
  int wrong = 0;
  const auto is = [&](double found, double stated) { wrong += found == stated ? 0 : 1; };
  const GnssConfig c;
  is(c.rate_hz, 2.0), is(c.mask_deg, 10.0), is(c.lever_arm_m.x(), -0.3), is(c.lever_arm_m.y(), 0.0),
      is(c.lever_arm_m.z(), 1.2);
  is(c.link.cn0_zenith_dbhz, 45.0), is(c.link.foliage_db_per_m, 0.25), is(c.link.foliage_max_db, 28.0);
  is(c.link.antenna_phase_centre, 0.0), is(c.tracking.correlator_spacing_chips, 0.5), is(c.tracking.code_loop_hz, 0.13);
  is(c.tracking.front_end_mhz, 0.0), is(c.tracking.carrier_loop_hz, 15.0), is(c.tracking.integration_ms, 20.0);
  is(c.tracking.thermal_noise_scale, 1.0), is(c.tracking.multipath_scale, 1.0);
  is(c.locks.tracking_threshold_dbhz, 25.0), is(c.locks.reacquisition_margin_db, 3.0), is(c.locks.reacquisition_s, 1.0);
  is(c.cn0_report.averaging_s, 0.0), is(c.cn0_report.resolution_db, 0.0), is(c.reception.cutoff_ns, 150.0);
  is(std::round(1e6 * c.reception.cutoff_m()), 44968869.0);
  is(c.position.raim_false_alarm, 1e-3), is(c.position.solver_sigma_m, 0.5), is(c.position.max_gdop, 100.0);
  is(c.position.estimator_acceleration_m_s2, 2.0), is(c.position.smoothing_s, 0.0),
      is(c.position.accuracy_limit_m, 0.0);
  is(c.propagation.surface_roughness_m, 0.0), is(c.propagation.ground_reflection, 0.0);
  is(c.propagation.reflection_borders, 0.0);
  const SineAntennaParameters sine;
  is(sine.horizon_loss_db, 7.0), is(sine.lhcp_rejection_db, 10.0);
  const LinkBudget link;
  is(link.cn0_zenith_dbhz, 45.0), is(link.foliage_db_per_m, 0.25), is(link.foliage_max_db, 28.0);
  is(link.antenna->rhcp_db(0.0), -7.0), is(link.antenna->lhcp_db(0.5 * kPi), -10.0);
  const CorrelatorDesign d;
  is(d.spacing_chips, 0.5), is(d.front_end_hz, 0.0), is(d.code_loop_hz, 0.5), is(d.carrier_loop_hz, 15.0),
      is(d.integration_s, 0.02);
  const SignalLockParameters l;
  is(l.interval_s, 1.0), is(l.threshold_dbhz, 25.0), is(l.reacquisition_margin_db, 3.0), is(l.reacquisition_s, 1.0);
  is(l.carrier_loop_hz, 15.0), is(l.integration_s, 0.02), is(l.slips, 1.0);
  const DgpsParameters b;
  is(b.baseline_km, 5.0), is(b.ionosphere_gradient_mm_per_km, 2.0), is(b.troposphere_gradient_mm_per_km, 1.0),
      is(b.base_error_scale, 1.0);
  const MultipathParameters m;
  is(m.cutoff_m, 45.0), is(m.threshold_dbhz, 25.0);
  const PathParameters p;
  is(p.cutoff_m, 45.0), is(p.weakest_db, -20.0), is(p.weakest_nlos_db, -20.0), is(p.combine_all_m, 30.0),
      is(p.leaning_reach_m, 1000.0);
  is(p.launched_rays, 20000.0), is(p.scattered_share.scatters ? 1.0 : 0.0, 0.0), is(p.roughness_m, 0.0);
  const PositionSolverParameters s;
  is(s.max_gdop, 100.0), is(s.false_alarm, 1e-3), is(s.max_exclusions, 8.0), is(RangeMeasurement{}.sigma_m, 1.0);
  const RangeErrorParameters e;
  const EnvironmentParameters n;
  is(e.correlation_s, 10.0), is(n.light_a_m2, 10.0), is(n.light_b_m2_hz, 22500.0), is(n.heavy_a_m2, 500.0),
      is(n.heavy_b_m2_hz, 1e6);
  is(RangeSignal{}.code_factor, 1.0), is(RangeWeightingParameters{}.sigma_m, 0.5), is(RangeQuality{}.code_factor, 1.0);
  const SinglePointConfig f;
  is(f.mask_deg, 10.0), is(f.max_gdop, 30.0), is(f.shared_ionosphere, 0.5), is(f.smoothing_s, 300.0),
      is(f.acceleration_m_s2, 1.0);
  is(f.base_age_s, 30.0), is(f.sigma_m, 0.5), is(f.doppler_sigma_m_s, 0.05), is(f.false_alarm, 1e-3),
      is(f.max_exclusions, 8.0);
  is(kDeepestLitNu, 3.0), is(kOverScreen_db, 6.0), is(IonexMaps{}.shell_height_m, 450e3),
      is(IonexMaps{}.base_radius_m, 6371e3);
  is(epoch_index(c, 0.0), 0.0), is(epoch_index(c, 10.24), 20.0), is(epoch_index(c, 10.26), 21.0),
      is(epoch_index(c, 3600.0), 7200.0);
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> default_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "keys that nobody sets", "a figure of the wrong power of ten",
           "as the manual states them: exact", "differences"});
  rows.add("asked/keys_as_they_come", keys_as_they_come);
  return rows.take();
}

}  // namespace canyon::gnss
