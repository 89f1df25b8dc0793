// Pseudoranges and their rates one by one, with clocks, systems and errors that last.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/fusion/states/range_errors.h"
#include "canyon/fusion/states/receiver_clock.h"
#include "canyon/fusion/stress/measurement_models/seen_state.h"
#include "canyon/fusion/stress/measurement_models/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::Looks;

GnssObservation satellite(const SeenState& seen, GnssSystem system, int prn, const Vector3d& direction_W) {
  GnssObservation o;
  o.sv = {system, static_cast<std::uint8_t>(prn)};
  o.p_E = seen.state.nav.p_EU_E + 2.2e7 * (kPlaceFrame.R_EW() * direction_W.normalized());
  o.v_E = kPlaceFrame.R_EW() * Vector3d(1500.0, -2000.0, 300.0);
  o.sigma_m = 1.5;
  o.pseudorange_m = 2.2e7 + 50.0;
  o.rate_m_s = (o.p_E - seen.state.nav.p_EU_E).normalized().dot(o.v_E - seen.state.nav.v_EU_E) + 0.7;
  return o;
}

/// Pseudoranges and rates one by one: the clock set by the middle one, and again after a jump; systems with their own
/// time; what lasts by C/N0, whether that is told or not; noise by its scale; places renewed by the way.
StressFigure ranges() {
  Looks looks;
  for (const bool lasting : {false, true}) {
    const std::vector<std::string> blocks = lasting ? std::vector<std::string>{"receiver_clock", "range_errors"}
                                                    : std::vector<std::string>{"receiver_clock"};
    SeenState seen(blocks, lasting ? "range_error_slots = 4\nrange_sigma_scale = 2\nrange_rate_sigma_m_s = 0.05" : "");
    const double scale = lasting ? 2.0 : 1.0, rate_sigma = lasting ? 0.05 : 0.2;
    Eigen::VectorXd clock(5);
    clock << 3.0, -0.4, 7.0, -2.0, 5.0;
    seen.set("receiver_clock", clock);
    const auto model = seen.model("ranges");
    GnssEpoch epoch{.t = kThen, .observations = {}};
    const Vector3d ways[] = {{1.0, 0.5, 2.0}, {-1.0, 0.3, 1.0}, {0.2, -1.0, 0.7}, {0.5, 0.6, 0.1}, {-0.7, -0.7, 1.5}};
    const GnssSystem systems[] = {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou,
                                  GnssSystem::kQzss};
    const double of_system[] = {0.0, 7.0, -2.0, 5.0, 0.0}, off[] = {0.0, 4.0, -6.0, 2.0, 11.0};
    for (int i = 0; i < 5; ++i) {
      epoch.observations.push_back(satellite(seen, systems[i], 10 + i, ways[i]));
      GnssObservation& o = epoch.observations.back();
      o.pseudorange_m = 2.2e7 + 900.0 + 3.0 + of_system[i] + off[i];
      o.clock_m = -30.0 * i, o.correction_m = 8.0 - 30.0 * i;  // together 8 m less
      o.cn0_dbhz = i == 3 ? kNaN : 45.0 - 6.0 * i;
    }
    const RangeErrorsParameters r;
    double set = 900.0 - 8.0 + 2.0;  // the middle of what is off: 2 m
    const auto look = [&](double shift) {
      looks.right(model->parts(seen.view(), epoch) == 10);
      for (int i = 0; i < 5; ++i) {
        const GnssObservation& o = epoch.observations[static_cast<std::size_t>(i)];
        const auto m = model->received(seen.view(), epoch, 2 * i), v = model->received(seen.view(), epoch, 2 * i + 1);
        if (!m || !v) return looks.right(false);
        const Vector3d u = (o.p_E - seen.state.nav.p_EU_E).normalized();
        const double up = u.dot(seen.state.nav.p_EU_E.normalized()),
                     cn0 = i == 3 ? 45.0 - 7.0 * (1.0 - up) : 45.0 - 6.0 * i;
        double residual = 900.0 - 8.0 + off[i] + shift - set, R = std::pow(scale * 1.5, 2);
        if (lasting) {
          residual -= r.mean_m(cn0);
          if (i < 4) residual -= r.sigma_m(cn0) * seen.state.values(seen.state.offset("range_errors") + i, 1)[0];
          if (i < 4) looks.close(m->H(0, seen.state.offset("range_errors") + i), r.sigma_m(cn0), 64.0);
          if (i == 4) R += r.sigma_m(cn0) * r.sigma_m(cn0);
        }
        looks.near(m->residual[0], residual, 3e-8), looks.close(m->R(0, 0), R, 64.0);
        looks.near(v->residual[0], 0.7 + 0.4, 1e-9);
        looks.close(v->R(0, 0), std::pow(rate_sigma * (lasting ? r.growth(cn0) : 1.0), 2), 64.0);
        const int at = seen.state.offset("receiver_clock");
        looks.right(m->H(0, at) == 1.0 && m->H(0, at + 1) == 0.0 && v->H(0, at + 1) == 1.0 && v->H(0, at) == 0.0);
        for (int s = 2; s < 5; ++s) looks.right(m->H(0, at + s) == (ClockIndex::of(o.sv.system) == s ? 1.0 : 0.0));
        looks.near((m->H.middleCols<3>(ErrorIndex::kPosition).transpose() + u).norm(), 0.0, 1e-12);
        looks.near((v->H.middleCols<3>(ErrorIndex::kVelocity).transpose() + u).norm(), 0.0, 1e-12);
      }
    };
    look(0.0);
    if (lasting) {
      looks.right(model->renewed().size() == 4);
      for (const Renewal& renewal : model->renewed()) looks.right(renewal.kept == 0.0);
      seen.set("range_errors", (Eigen::VectorXd(4) << 0.5, -1.0, 0.3, 0.2).finished());
    } else {
      looks.right(model->renewed().empty());
    }
    // Two seconds of 8 m/s of the 50 m over which echoes change.
    epoch.t = epoch.t + 2.0;
    seen.state.nav.t = epoch.t;
    look(0.0);
    if (lasting) {
      looks.right(model->renewed().size() == 4);
      for (const Renewal& renewal : model->renewed()) looks.near(renewal.kept, std::exp(-16.0 / 50.0), 1e-12);
    }
    // A kilometre is the state's to find; a jump of a millisecond is taken out.
    for (GnssObservation& o : epoch.observations) o.pseudorange_m += 2900.0;
    look(2900.0);
    for (GnssObservation& o : epoch.observations) o.pseudorange_m += 296892.458;
    set += 299792.458;
    look(299792.458);
    epoch.observations[1].sigma_m = 0.0;
    looks.right(!model->received(seen.view(), epoch, 2) && model->received(seen.view(), epoch, 3));
    model->start();
    set = 900.0 - 8.0 + 2.0 + 299792.458;
    epoch.observations[1].sigma_m = 1.5;
    look(299792.458);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> range_cases() {
  StressRows rows = measured_rows();
  rows.add("measurement_models/ranges", ranges);
  return rows.take();
}

}  // namespace canyon::fusion
