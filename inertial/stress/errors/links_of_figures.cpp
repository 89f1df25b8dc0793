// Which links a unit has: those that its figures bring, and no others.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress_rows.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/stress/errors/one_link.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using made::kStep_s;
using made::link_of;
using made::still;
using made::through;

/// A unit without figures has no links, and each figure brings its own link alone; white noise with a seed of its own
/// is that of a unit of that seed.
StressFigure which_links() {
  int wrong = 0;
  const LinkSetup bare{.figures = {}, .environment = {}, .seed = 3, .dt_s = kStep_s};
  LinkSetup around = bare;
  around.environment.temperatures_c = {40.0}, around.environment.temperature_times_s = {0.0};
  around.environment.vibration_rms_m_s2 = Vector3d(1.0, 1.0, 1.0);
  const std::vector<std::pair<std::string, double TriadFigures::*>> of_triads = {
      {"misalignment", &TriadFigures::misalignment_rad},
      {"package_misalignment", &TriadFigures::package_rad},
      {"scale_factor", &TriadFigures::scale},
      {"scale_asymmetry", &TriadFigures::scale_asymmetry},
      {"turn_on_bias", &TriadFigures::turn_on_bias},
      {"in_run_bias", &TriadFigures::in_run_bias},
      {"flicker", &TriadFigures::bias_instability},
      {"rate_random_walk", &TriadFigures::rate_random_walk},
      {"ramp", &TriadFigures::ramp},
      {"temperature", &TriadFigures::bias_temperature},
      {"temperature", &TriadFigures::scale_temperature},
      {"vibration_rectification", &TriadFigures::vibration_rectification},
      {"white_noise", &TriadFigures::white_per_sqrt_hz},
      {"quantization_noise", &TriadFigures::quantization_noise},
      {"cross_talk", &TriadFigures::cross_talk},
      {"dead_band", &TriadFigures::dead_band},
      {"saturation", &TriadFigures::range},
      {"quantization", &TriadFigures::resolution},
      {"g_sensitivity", &TriadFigures::g_sensitivity}};
  for (const auto& row : error_links()) wrong += row.make(around) ? 1 : 0;
  for (const auto& [name, figure] : of_triads)
    for (const bool gyro : {true, false}) {
      LinkSetup one = around;
      TriadFigures& triad = gyro ? one.figures.gyro : one.figures.accel;
      triad.*figure = 0.1;
      for (const auto& row : error_links()) {
        const bool expected = row.name == name && (gyro || name != "g_sensitivity");
        wrong += (row.make(one) != nullptr) == expected ? 0 : 1;
      }
      one.environment = bare.environment;
      if (name == "temperature" || name == "vibration_rectification") wrong += link_of(name, one) ? 1 : 0;
    }
  const std::vector<std::pair<std::string, double UnitFigures::*>> of_units = {{"latency", &UnitFigures::latency_s},
                                                                               {"losses", &UnitFigures::loss_share},
                                                                               {"clock", &UnitFigures::clock_skew},
                                                                               {"clock", &UnitFigures::clock_jitter_s}};
  for (const auto& [name, figure] : of_units) {
    LinkSetup one = around;
    one.figures.*figure = 0.01;
    for (const auto& row : error_links()) wrong += (row.make(one) != nullptr) == (row.name == name) ? 0 : 1;
  }
  LinkSetup seeded = bare, other = bare;
  seeded.figures.gyro.white_per_sqrt_hz = other.figures.gyro.white_per_sqrt_hz = 1.0;
  seeded.noise_seed = other.seed = 77;
  const auto a = through(*link_of("white_noise", seeded), 10, still(20)),
             b = through(*link_of("white_noise", other), 10, still(20));
  for (std::size_t k = 0; k < a.size(); ++k) wrong += a[k][0] == b[k][0] && a[k][1].isZero(0.0) ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> link_of_figure_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "which links a unit has",
           "a link that another's figure brings, or a triad's that is bare",
           "none without figures, and with each its own alone: exact", "wrong"});
  rows.add("links/which_there_are", which_links);
  return rows.take();
}

}  // namespace canyon::inertial
