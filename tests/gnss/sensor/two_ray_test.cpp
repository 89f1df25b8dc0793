// Two rays through the whole receiver: what a wall does to code, carrier and C/N0 of each band as an antenna is moved
// before it by centimetres, against the closed form of an early-late loop.
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/receiver/code_correlation.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/satellites/glonass_channels.h"
#include "canyon/gnss/signal.h"
#include "canyon/tests/gnss/paths/wall_scene.h"
#include "canyon/tests/gnss/sensor/gnss_keys.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

using testing::errors_off;
using testing::PseudorangeSensorTest;
using testing::WallScene;

struct TwoRayBand {
  const char* name;
  const char* system;
  const char* second;  ///< of mode dual; "": the first signal is looked at
};

class TwoRay : public PseudorangeSensorTest, public ::testing::WithParamInterface<TwoRayBand> {
 protected:
  /// What is measured of one signal, of either band.
  struct Measured {
    double range_m, phase_cycles, cn0_dbhz;
    int band;
  };
  static Measured of(const GnssObservation& o, bool second) {
    if (second) return {o.second.pseudorange_m, o.second.carrier_phase_cycles, o.second.cn0_dbhz, o.second.band};
    return {o.pseudorange_m, o.carrier_phase_cycles, o.cn0_dbhz, o.band};
  }
  GnssConfig config() const {
    GnssConfig c = errors_off();
    const TwoRayBand& band = GetParam();
    c.satellites.systems = band.system;
    c.propagation.paths.name = "specular1";
    c.reception.multipath_rule.name = "correlator";
    testing::set_keys(c, "correlator_spacing_chips = 0.5\nfront_end_mhz = 0.0\n");
    if (band.second[0] != '\0') {
      c.mode.name = "dual";
      testing::set_keys(c, std::string("second_frequency = \"") + band.second + "\"\n");
    }
    return c;
  }
};

// With echo a e^(j phi), delay d below half the spacing, both loops of powers balance on straight flanks at
//
//   tau = d (a^2 + a cos phi) / (1 + 2 a cos phi + a^2),
//
// and the carrier loop follows (1 - tau) + a e^(j phi) (1 - |tau - d|), in chips (Braasch 1996; van Nee 1993). Echo and
// phase are the tracer's for the satellite's direction in W, which is that at the antenna to 1e-6 rad: 2e-4 rad of
// phase at 6 m. Where the sum is 0.3 at least that is 1.3 cm of tau at most, 6e-3 dB, and 1e-4 cycles.
TEST_P(TwoRay, CodeCarrierAndPowerAreThoseOfTheClosedForm) {
  const bool second = GetParam().second[0] != '\0';
  const auto walled = WallScene().wall({-3, -400, 0}, {0, 800, 0}, {0, 0, 400}, "metal").build();
  const auto open = WallScene().wall({-9e4, -5, 0}, {0, 10, 0}, {0, 0, 3}).build();
  const GnssConfig c = config();
  const LinkBudget link = *c.link.budget();
  scene = WallScene().wall({-3, -400, 0}, {0, 800, 0}, {0, 0, 400}, "metal").build();
  const auto with = make(c);
  scene = WallScene().wall({-9e4, -5, 0}, {0, 10, 0}, {0, 0, 3}).build();
  const auto without = make(c);
  const auto tracer = find_model(path_models(), "specular1")->make({}, {});
  int compared = 0;
  double weakest_db = 1e9, strongest_db = -1e9;
  for (int k = 0; k <= 30; ++k) {
    const Eigen::Vector3d p(0.01 * k, 0.0, 2.0);
    const GnssOutput a = with->measure(20 * k, testing::kStart, p, still, scene::SceneAt(*walled));
    const GnssOutput b = without->measure(20 * k, testing::kStart, p, still, scene::SceneAt(*open));
    for (const GnssObservation& oa : a.epoch.observations) {
      for (const GnssObservation& ob : b.epoch.observations) {
        if (oa.sv != ob.sv) continue;
        const Measured ma = of(oa, second), mb = of(ob, second);
        if (ma.band == 0 || mb.band == 0) continue;
        GnssObservationTruth truth;
        for (const auto& t : a.truth.satellites)
          if (t.sv == oa.sv) truth = t;
        if (!truth.line_of_sight || truth.reflections != 1) continue;
        const Eigen::Vector3d s = testing::direction(truth.azimuth_rad / kDegree, truth.elevation_rad / kDegree);
        const int channel = oa.sv.system == GnssSystem::kGlonass ? glonass_channel_plan()[oa.sv.prn] : 0;
        const double hz = carrier_hz(oa.sv.system, ma.band, channel), wavelength_m = kSpeedOfLight / hz;
        std::vector<SignalPaths> paths(1);
        GnssCounters counters;
        const std::vector<Eigen::Vector3d> directions{s};
        const std::vector<double> carriers{hz};
        tracer->trace(p, {directions, carriers}, scene::SceneAt(*walled), paths, counters);
        ASSERT_EQ(paths[0].echoes.size(), 1U);
        const ReceivedSignal echo = receive(paths[0].echoes[0], link, Eigen::Vector3d::UnitZ(), s, still, wavelength_m);
        const double direct_dbhz = link.direct_cn0_dbhz(truth.elevation_rad, 0.0, 1.0);
        const double ratio = std::pow(10.0, (echo.cn0_dbhz - direct_dbhz) / 20.0), d_m = echo.excess_m;
        const double chip_m = CodeCorrelation(modulation_of(oa.sv.system, ma.band), 0.0).chip_m();
        ASSERT_LT(d_m, 0.25 * chip_m) << oa.sv.str();
        const double cosine = std::cos(echo.phase_rad), power = 1.0 + 2.0 * ratio * cosine + ratio * ratio;
        const double tau_m = d_m * (ratio * ratio + ratio * cosine) / power;
        const std::complex<double> carrier = (1.0 - std::abs(tau_m) / chip_m) +
                                             std::polar(ratio, echo.phase_rad) * (1.0 - std::abs(tau_m - d_m) / chip_m);
        if (std::abs(carrier) < 0.3) continue;  // deep in a fade all is steep
        EXPECT_NEAR(ma.range_m - mb.range_m, tau_m, 0.02) << oa.sv.str() << " " << k;
        EXPECT_NEAR(ma.cn0_dbhz - mb.cn0_dbhz, 20.0 * std::log10(std::abs(carrier)), 0.01) << oa.sv.str() << " " << k;
        const double turned = -(ma.phase_cycles - mb.phase_cycles) - std::arg(carrier) / (2.0 * kPi);
        EXPECT_NEAR(std::remainder(turned, 1.0), 0.0, 1e-3) << oa.sv.str() << " " << k;
        weakest_db = std::min(weakest_db, ma.cn0_dbhz - mb.cn0_dbhz);
        strongest_db = std::max(strongest_db, ma.cn0_dbhz - mb.cn0_dbhz);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 30);
  EXPECT_GT(strongest_db - weakest_db, 3.0) << "30 cm are more than a fringe";
}

INSTANTIATE_TEST_SUITE_P(Bands, TwoRay,
                         ::testing::Values(TwoRayBand{"L1", "G", ""}, TwoRayBand{"L2", "G", "L2"},
                                           TwoRayBand{"L5", "G", "L5"}, TwoRayBand{"G1", "R", ""},
                                           TwoRayBand{"B1I", "C", ""}),
                         [](const auto& band) { return std::string(band.param.name); });

}  // namespace
}  // namespace canyon::gnss
