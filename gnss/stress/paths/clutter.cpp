// What a street's clutter is made of: fields over a lattice, scatterers, shades, and delays that are gathered.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/clutter/clutter.h"
#include "canyon/gnss/paths/clutter/clutter_scatterers.h"
#include "canyon/gnss/paths/clutter/lattice_noise.h"
#include "canyon/gnss/paths/clutter/street_shading.h"
#include "canyon/gnss/paths/clutter/two_state_law.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/paths/scatter/delay_bins.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/paths/plain.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;
using Hand = std::complex<double>;

/// Between its corners a field is their sum with cosines and sines of the stated angle along each coordinate, whatever
/// their number: roundings; and over far corners it is standard normal, 5 deviations of 20000.
StressFigure lattices() {
  Looks looks;
  const RandomStream draws(4, "stress.receptions");
  const LatticeNoise noise(11, "stress.lattice");
  const auto angle = [](double f) { return 0.5 * kPi * f * f * (3.0 - 2.0 * f); };
  for (int k = 0; k < 200; ++k) {
    std::array<double, 3> x{draws.uniform(-90, 90, 0, k), draws.uniform(-90, 90, 1, k), draws.uniform(-90, 90, 2, k)};
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      std::array<double, 3> at{};
      double weight = 1.0;
      for (std::size_t d = 0; d < 3; ++d) {
        const double low = std::floor(x[d]), theta = angle(x[d] - low);
        const bool upper = (corner >> d & 1) != 0;
        at[d] = low + (upper ? 1.0 : 0.0);
        weight *= upper ? std::sin(theta) : std::cos(theta);
      }
      sum += weight * noise.at<3>(at, 5);
    }
    looks.near(noise.at<3>(x, 5), sum, 1e-13);
    looks.right(noise.at<3>(x, 5) != noise.at<3>(x, 6));
  }
  double mean = 0.0, square = 0.0;
  constexpr int kN = 20000;
  for (int k = 0; k < kN; ++k) {
    const double v = noise.at<2>({3.0 * k + 0.3, 0.7 - 2.0 * k}, 1);
    mean += v / kN, square += v * v / kN;
  }
  looks.near(mean, 0.0, 5.0 / std::sqrt(1.0 * kN));
  looks.near(square, 1.0, 5.0 * std::sqrt(2.0 / kN));
  return looks.figure();
}

/// One scatterer in each cell, evenly within it and up to 5 m over the ground; those within a radius and no others;
/// hands of variance 1. Of 10000 cells: 5 deviations of means and squares.
StressFigure scatterers() {
  Looks looks;
  const scene::Scene plain = plain_at(7.0, 0.0);
  const ClutterScatterers all(3.0, 5);
  std::vector<ClutterScatterer> found, within;
  all.near(plain, {10.0, -20.0, 0.0}, 170.0, found);
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero();
  double co = 0.0, cross = 0.0;
  std::vector<std::pair<int, int>> cells;
  const auto n = static_cast<double>(found.size());
  looks.near(n / (kPi * 170.0 * 170.0 / 9.0), 1.0, 0.02);
  for (const ClutterScatterer& s : found) {
    const double fx = s.p_W.x() / 3.0 - std::floor(s.p_W.x() / 3.0), fy = s.p_W.y() / 3.0 - std::floor(s.p_W.y() / 3.0),
                 fz = (s.p_W.z() - 7.0) / 5.0;
    looks.right(fz >= 0.0 && fz < 1.0 && (s.p_W.head<2>() - Eigen::Vector2d(10.0, -20.0)).norm() < 170.0);
    const Vector3d f(fx, fy, fz);
    mean += f / n, square += f.cwiseAbs2() / n;
    co += std::norm(s.co) / n, cross += std::norm(s.cross) / n;
    cells.emplace_back(static_cast<int>(std::floor(s.p_W.x() / 3.0)), static_cast<int>(std::floor(s.p_W.y() / 3.0)));
  }
  std::sort(cells.begin(), cells.end());
  looks.right(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
  for (int a = 0; a < 3; ++a) {
    looks.near(mean[a], 0.5, 5.0 / std::sqrt(12.0 * n));
    looks.near(square[a], 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / n));
  }
  looks.near(co, 1.0, 5.0 / std::sqrt(n)), looks.near(cross, 1.0, 5.0 / std::sqrt(n));
  all.near(plain, {40.0, 15.0, 0.0}, 25.0, within);
  std::size_t expected = 0;
  for (const ClutterScatterer& s : found)
    expected += (s.p_W.head<2>() - Eigen::Vector2d(40.0, 15.0)).norm() < 25.0 ? 1 : 0;
  looks.right(within.size() == expected);
  return looks.figure();
}

/// Shades over far places and times are spread as the law says of independent normal numbers: means and squares of
/// 20000, against 200000 drawn; 5 deviations.
StressFigure shades(double elevation_rad) {
  Looks looks;
  const RandomStream draws(4, "stress.receptions");
  const TwoStateLaw law(TwoStateLaw::environments().front(), 1.0);
  const StreetShading shading(law, {}, 3, 9);
  double mean = 0.0, square = 0.0, expected = 0.0, expected2 = 0.0;
  constexpr int kN = 20000, kDrawn = 200000;
  for (int k = 0; k < kN; ++k) {
    const double a = draws.uniform(-kPi, kPi, 0, k);
    const Vector3d from(std::cos(elevation_rad) * std::cos(a), std::cos(elevation_rad) * std::sin(a),
                        std::sin(elevation_rad));
    const double db =
        shading.level_db({61.3 * k, -83.7 * k, 0.0}, from, GpsTime::from_week_sow(1600, 31.7 * (k % 19000)));
    mean += db / kN, square += db * db / kN;
    // From below the ground as from above it on the same side.
    if (k % 500 == 0)
      looks.near(shading.level_db({1.0, 2.0, 0.0}, {from.x(), from.y(), -from.z()}, GpsTime{}) -
                     shading.level_db({1.0, 2.0, 0.0}, from, GpsTime{}),
                 0.0, 1e-12);
  }
  for (std::uint64_t k = 0; k < kDrawn; ++k) {
    const double ma = law.mean_level_db(draws.normal(20, k), elevation_rad);
    const double db = ma + law.spread_db(ma, elevation_rad) * draws.normal(21, k);
    expected += db / kDrawn, expected2 += db * db / kDrawn;
  }
  const double variance = expected2 - expected * expected;
  looks.near(mean, expected, 5.0 * std::sqrt(variance * (1.0 / kN + 1.0 / kDrawn)));
  // A fourth moment of up to ten variances squared: a mixture of two states.
  looks.near(square - mean * mean, variance, 5.0 * variance * std::sqrt(10.0 / kN));
  return looks.figure();
}

/// Phasors gathered by delay add up at the carrier as they are, to roundings of 600 m in wavelengths; powers in squares
/// of their shares, and one direction has no spread.
StressFigure gathered() {
  Looks looks;
  const RandomStream draws(4, "stress.receptions");
  const double wave_m = 0.19029367;
  DelayBins bins;
  bins.clear(wave_m);
  Hand co = 0.0, cross = 0.0;
  std::vector<double> power(DelayBins::kBins, 0.0);
  for (int k = 0; k < 200; ++k) {
    const double excess = draws.uniform(0.0, 620.0, 0, k);
    const DelayBins::Phasor phasor{std::polar(draws.uniform(0, 1, 1, k), draws.uniform(-3, 3, 2, k)),
                                   std::polar(draws.uniform(0, 1, 3, k), draws.uniform(-3, 3, 4, k))};
    bins.add(phasor, excess, Vector3d::UnitX(), 1.0);
    const auto first = static_cast<std::size_t>(excess / 15.0);
    if (first + 1 >= DelayBins::kBins) continue;
    const double share = excess / 15.0 - static_cast<double>(first);
    co += phasor.co * std::polar(1.0, -2.0 * kPi * excess / wave_m);
    cross += phasor.cross * std::polar(1.0, -2.0 * kPi * excess / wave_m);
    const double both = std::norm(phasor.co) + std::norm(phasor.cross);
    power[first] += (1.0 - share) * (1.0 - share) * both, power[first + 1] += share * share * both;
  }
  Hand co_sum = 0.0, cross_sum = 0.0;
  for (std::size_t i = 0; i < DelayBins::kBins; ++i) {
    const Hand turn = std::polar(1.0, -2.0 * kPi * 15.0 * static_cast<double>(i) / wave_m);
    co_sum += bins.bins()[i].co * turn, cross_sum += bins.bins()[i].cross * turn;
    looks.near(bins.bins()[i].co_power + bins.bins()[i].cross_power, power[i], 1e-12);
  }
  looks.near(std::abs(co_sum - co), 0.0, 1e-9), looks.near(std::abs(cross_sum - cross), 0.0, 1e-9);
  std::vector<SignalPath> out;
  const double least = 1.5;
  bins.append(least, SignalPath::kClutter, out);
  for (const SignalPath& path : out) {
    const auto i = static_cast<std::size_t>(std::lround(path.excess_m / 15.0));
    const DelayBins::Bin& bin = bins.bins()[i];
    const double sum = std::norm(bin.co) + std::norm(bin.cross), amplitude = std::sqrt(sum > power[i] ? sum : power[i]);
    const double kept = amplitude / least - 1.0 > 1.0 ? 1.0 : amplitude / least - 1.0;
    looks.near(std::abs(path.copolar - kept * bin.co), 0.0, 1e-13);
    looks.near(std::abs(path.crosspolar - kept * bin.cross), 0.0, 1e-13);
    looks.near(path.gathered_copolar + path.gathered_crosspolar, kept * kept * power[i], 1e-12);
    looks.near(path.spread, 0.0, 1e-7);
    looks.near((path.arrival_W - Vector3d::UnitX()).norm(), 0.0, 1e-14);
    looks.right(path.facets[0] == SignalPath::kClutter && path.facets[1] == i);
  }
  looks.right(out.size() > 10);
  // Two directions at right angles of equal power: mean 1 / sqrt 2 long, spread as much.
  bins.clear(wave_m);
  bins.add({1.0, 0.0}, 30.0, Vector3d::UnitX(), 1.0);
  bins.add({Hand(0.0, 1.0), 0.0}, 30.0, Vector3d::UnitY(), 1.0);
  out.clear();
  bins.append(1e-3, SignalPath::kScattered, out);
  looks.right(out.size() == 1);
  if (out.size() == 1) looks.near(out[0].spread, std::sqrt(0.5), 1e-12);
  return looks.figure();
}

/// A whole street's clutter where everything is in sight and lit: over 80 streets what arrives beside a satellite's
/// signal has the multipath power that the table states for its elevation, half of it of either hand, at the carrier:
/// five deviations of exponential powers. The straight way and an echo are shaded by where they come from, as the field
/// of shades says at that place and time, to roundings.
StressFigure whole_street(double elevation_rad, double echo_db) {
  Looks looks;
  const scene::Scene plain = plain_at(0.0, 0.25);
  const scene::SceneAt at(plain);
  const Vector3d antenna(-120.0, -60.0, 2.0), from = Vector3d(0.3, -0.4, 0.8).normalized();
  const std::vector<Vector3d> sky{{std::cos(elevation_rad), 0.0, std::sin(elevation_rad)}};
  const GpsTime t = GpsTime::from_week_sow(1700, 5000.0);
  const TwoStateLaw law("suburban", 1.0);
  PathParameters p;
  p.weakest_db = p.weakest_nlos_db = -140.0, p.seed = 6;
  ModelParameters own;
  street_clutter_parameters(own);
  constexpr int kStreets = 80;
  double co = 0.0, cross = 0.0;
  for (int street = 0; street < kStreets; ++street) {
    const auto node = ConfigNode::parse(
        "clutter_street = " + std::to_string(street) + "\nclutter_echo_db = " + std::to_string(echo_db), "stress");
    CANYON_CHECK(node && read_fields(&*node, "gnss", [&own](FieldVisitor& f) { own.visit_all(f); }).ok(), street);
    const auto model = make_street_clutter(own, p);
    std::vector<SignalPaths> out(1);
    SignalPath echo;
    echo.excess_m = 3.0, echo.copolar = {0.5, 0.1}, echo.crosspolar = {0.0, 0.2}, echo.arrival_W = from;
    out[0].echoes.push_back(echo);
    GnssCounters counters;
    model->trace(antenna, PlaneWaves(sky).at(t), at, out, counters);
    const StreetShading shading(law, {}, static_cast<std::uint64_t>(street), p.seed);
    const double straight = std::pow(10.0, shading.level_db(antenna, sky[0], t) / 20.0),
                 beside = std::pow(10.0, shading.level_db(antenna, from, t) / 20.0);
    looks.near(std::abs(out[0].direct - straight), 0.0, 1e-13);
    looks.right(out[0].echoes.size() > 3);
    looks.near(std::abs(out[0].echoes[0].copolar - beside * echo.copolar), 0.0, 1e-13);
    looks.near(std::abs(out[0].echoes[0].crosspolar - beside * echo.crosspolar), 0.0, 1e-13);
    Hand co_sum = 0.0, cross_sum = 0.0;
    for (std::size_t k = 1; k < out[0].echoes.size(); ++k) {
      const SignalPath& path = out[0].echoes[k];
      const Hand turn = std::polar(1.0, -2.0 * kPi * path.excess_m / kL1WavelengthM);
      co_sum += path.copolar * turn, cross_sum += path.crosspolar * turn;
      looks.right(path.facets[0] == SignalPath::kClutter && path.excess_m >= 0.0 && path.excess_m < 2.0 * 85.0 + 30.0);
    }
    co += std::norm(co_sum) / kStreets, cross += std::norm(cross_sum) / kStreets;
  }
  const double half = 0.5 * law.multipath_power(false, elevation_rad) * std::pow(10.0, echo_db / 10.0);
  for (const double found : {co, cross}) looks.near(found / half, 1.0, 5.0 / std::sqrt(1.0 * kStreets));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> clutter_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "fields over a street, and scatterers in it",
           .why = "corners that are exchanged, a cell that has two, a level of another elevation",
           .expected = "sums over corners, counts, and the law's mean and spread to five deviations",
           .unit = "of the bound"});
  rows.add("clutter/lattices", lattices).add("clutter/scatterers", scatterers).add("clutter/gathered_delays", gathered);
  for (const double e : {0.4, 0.9})
    rows.add("clutter/shades_at_" + stress::text(e) + "_rad", [e] { return shades(e); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a whole street's clutter, all of it in sight",
           .why = "a hand of the other's power, an amplitude for a power, a shade of another direction",
           .expected = "the table's multipath over many streets, five deviations; shades to roundings",
           .unit = "of the bound"});
  rows.add("clutter/whole_street_at_0.5_rad", [] { return whole_street(0.5, 0.0); })
      .add("clutter/whole_street_at_1.1_rad_6_db_stronger", [] { return whole_street(1.1, 6.0); });
  return rows.take();
}

}  // namespace canyon::gnss
