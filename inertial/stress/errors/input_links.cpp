// Links of the error chain that act on the input: what each adds, against its law, and over many units the size that
// its figure says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/stress/errors/one_link.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using made::added;
using made::Increments;
using made::kBlock;
using made::kStep_s;
using made::link_of;
using made::still;
using made::through;
using stress::kEpsilon;
using stress::Looks;

/// Numbers that should be independent unit normals, one row for each of many units: means, squares and products of any
/// two, each to five of its standard deviations.
class UnitNormals {
 public:
  void take(const std::vector<double>& row) { rows_.push_back(row); }
  void look(Looks& looks) const {
    const auto n = static_cast<double>(rows_.size());
    const std::size_t width = rows_.front().size();
    for (std::size_t i = 0; i < width; ++i) {
      double mean = 0.0;
      for (const auto& row : rows_) mean += row[i] / n;
      looks.near(mean, 0.0, 5.0 / std::sqrt(n));
      for (std::size_t j = i; j < width; ++j) {
        double product = 0.0;
        for (const auto& row : rows_) product += row[i] * row[j] / n;
        looks.near(product, i == j ? 1.0 : 0.0, 5.0 * std::sqrt((i == j ? 2.0 : 1.0) / n));
      }
    }
  }

 private:
  std::vector<std::vector<double>> rows_;
};

/// Links that are a matrix on the input: found from unit inputs, it holds for any other of the samples; the units'
/// elements are independent normals of the figure, where there are any, and nothing elsewhere.
StressFigure matrix_link(const std::string& name, double TriadFigures::*figure, double gyro, double accel) {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  setup.figures.gyro.*figure = gyro, setup.figures.accel.*figure = accel;
  const bool of_force = name == "g_sensitivity", turn = name == "package_misalignment",
             diagonal = name == "scale_factor";
  const RandomStream draws(1, "stress.links");
  UnitNormals normals;
  for (setup.seed = 1; setup.seed <= 400; ++setup.seed) {
    const auto link = link_of(name, setup);
    looks.right(link != nullptr && link->memory() == 0);
    if (!link) return looks.figure();
    std::vector<Increments> in = still(12);
    for (Eigen::Index i = 0; i < 6; ++i) in[static_cast<std::size_t>(i)][i < 3 ? 0 : 1][i % 3] = 1.0;
    for (std::size_t k = 6; k < in.size(); ++k) in[k] = {draws.normal3(k, 0), draws.normal3(k, 1)};
    const auto error = added(*link, kBlock - 5, in);  // over a border
    Eigen::Matrix<double, 6, 6> M;
    for (Eigen::Index i = 0; i < 6; ++i)
      M.col(i) << error[static_cast<std::size_t>(i)][0], error[static_cast<std::size_t>(i)][1];
    for (std::size_t k = 6; k < in.size(); ++k) {
      Eigen::Matrix<double, 6, 1> x, e;
      x << in[k][0], in[k][1];
      e << error[k][0], error[k][1];
      looks.near((e - M * x).norm(), 0.0, 64.0 * kEpsilon * (1.0 + M.norm()) * x.norm());
    }
    std::vector<double> row;
    for (Eigen::Index to = 0; to < 2; ++to)
      for (Eigen::Index from = 0; from < 2; ++from) {
        const Matrix3d part = M.block<3, 3>(3 * to, 3 * from);
        const double sigma = to == 0 ? gyro : accel;
        const bool acts = of_force ? to == 0 && from == 1 : to == from && sigma > 0.0;
        if (!acts) {
          looks.right(part.isZero(0.0));
        } else if (turn) {
          // What is left with the identity turns, and its vector is the draw.
          const Matrix3d R = Matrix3d::Identity() + part;
          looks.near((R * R.transpose() - Matrix3d::Identity()).norm(), 0.0, 32.0 * kEpsilon);
          const Vector3d v = so3_log(Eigen::Quaterniond(R)) / sigma;
          row.insert(row.end(), {v.x(), v.y(), v.z()});
        } else {
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
              const bool there = of_force || (i == j) == diagonal;
              if (there) row.push_back(part(i, j) / sigma);
              if (!there) looks.near(part(i, j), 0.0, 8.0 * kEpsilon);
            }
        }
      }
    normals.take(row);
  }
  normals.look(looks);
  return looks.figure();
}

/// Links that bend the input: by half its size in either direction, by polynomials of the range's share, by a band that
/// is not seen.
StressFigure curved_links() {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  constexpr double kRange[2] = {5.0, 80.0}, kAsymmetry[2] = {3e-3, 7e-3}, kBent[2] = {2e-3, 5e-4},
                   kBand[2] = {0.3, 4.0};
  for (std::size_t t = 0; t < 2; ++t) {
    TriadFigures& f = t == 0 ? setup.figures.gyro : setup.figures.accel;
    f.range = kRange[t], f.scale_asymmetry = kAsymmetry[t], f.nonlinearity = kBent[t], f.dead_band = kBand[t];
  }
  // Shares of the range, every one with both signs; beyond it the curve stays at its end.
  std::vector<double> shares;
  for (const double s : {1e-3, 0.02, 0.1, 0.33, 0.5, 0.77, 0.99, 1.0, 1.3, 4.0})
    for (const double sign : {-1.0, 1.0}) shares.push_back(sign * s);
  std::vector<Increments> in;
  for (const double s : shares)
    in.push_back(
        {kStep_s * kRange[0] * s * Vector3d(1.0, -1.0, 1.0), kStep_s * kRange[1] * s * Vector3d(-1.0, 1.0, 1.0)});
  UnitNormals asymmetric, bent;
  for (setup.seed = 1; setup.seed <= 300; ++setup.seed) {
    const auto asymmetry = link_of("scale_asymmetry", setup), curve = link_of("nonlinearity", setup);
    const auto a = added(*asymmetry, 7, in), c = added(*curve, 7, in);
    std::vector<double> sizes, squares;
    for (std::size_t t = 0; t < 2; ++t)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double unit = kStep_s * kRange[t];
        // The last pair lies far beyond, the eighth at the end of the range.
        const double gain = a[14][t][axis] / unit;
        sizes.push_back(gain / kAsymmetry[t]);
        const double even = 0.5 * (c[14][t][axis] + c[15][t][axis]) / unit, hand = in[15][t][axis] > 0.0 ? 1.0 : -1.0,
                     odd = 0.5 * hand * (c[15][t][axis] - c[14][t][axis]) / unit;
        // At the end 2 r^2 is 2 and 4 r^3 - 3 r is 1; together as large as the figure says, half the square each.
        squares.push_back(0.5 * even / kBent[t] * std::sqrt(2.0)), squares.push_back(odd / kBent[t] * std::sqrt(2.0));
        for (std::size_t k = 0; k < in.size(); ++k) {
          const double x = in[k][t][axis], r = std::clamp(x / unit, -1.0, 1.0);
          looks.near(a[k][t][axis], gain * std::abs(x), 8.0 * kEpsilon * std::abs(x));
          looks.near(c[k][t][axis] / unit, even * r * r + odd * (4.0 * r * r * r - 3.0 * r),
                     16.0 * kEpsilon * (kBent[t] * 8.0 + std::abs(x / unit)));
        }
      }
    asymmetric.take(sizes), bent.take(squares);
  }
  asymmetric.look(looks), bent.look(looks);
  const auto band = link_of("dead_band", setup);
  std::vector<Increments> small;
  for (const double s : {-2.0, -1.0001, -0.9999, -0.2, 0.0, 0.5, 0.9999, 1.0001, 3.0})
    small.push_back(
        {kStep_s * kBand[0] * Vector3d(s, -s, 0.5 * s), kStep_s * kBand[1] * Vector3d(0.1 * s, s, -2.0 * s)});
  const auto out = through(*band, 300, small);
  for (std::size_t k = 0; k < small.size(); ++k)
    for (std::size_t t = 0; t < 2; ++t)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double x = small[k][t][axis];
        looks.right(out[k][t][axis] == (std::abs(x) < kStep_s * kBand[t] ? 0.0 : x));
      }
  return looks.figure();
}

/// Biases that are a function of time and surroundings: constant, a ramp, a temperature's and a vibration's. What each
/// axis has drawn is found from one sample and says all others, to roundings; over many units it is of the figure's
/// size.
StressFigure stated_biases() {
  Looks looks;
  constexpr double kTurnOn[2] = {0.02, 0.3}, kSlope[2] = {1e-4, 2e-3}, kPerK[2] = {1e-3, 4e-3}, kGain[2] = {2e-4, 5e-4},
                   kRectified[2] = {3e-4, 2e-3};
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  for (std::size_t t = 0; t < 2; ++t) {
    TriadFigures& f = t == 0 ? setup.figures.gyro : setup.figures.accel;
    f.turn_on_bias = kTurnOn[t], f.ramp = kSlope[t], f.bias_temperature = kPerK[t], f.scale_temperature = kGain[t],
    f.vibration_rectification = kRectified[t];
  }
  setup.figures.reference_temperature_c = 21.0;
  setup.environment.temperature_times_s = {1.0, 3.0, 7.0};
  setup.environment.temperatures_c = {-10.0, 30.0, 55.0};
  setup.environment.vibration_rms_m_s2 = Vector3d(3.0, 5.0, 11.0);
  const auto temperature = [](double t_s) {
    return t_s < 1.0 ? -10.0 : t_s < 3.0 ? -10.0 + 20.0 * (t_s - 1.0) : t_s < 7.0 ? 30.0 + 6.25 * (t_s - 3.0) : 55.0;
  };
  const RandomStream draws(2, "stress.links");
  std::vector<Increments> in;
  for (std::uint64_t k = 0; k < 500; ++k) in.push_back({kStep_s * draws.normal3(k, 0), kStep_s * draws.normal3(k, 1)});
  UnitNormals normals;
  std::array<double, 12> positive{};
  constexpr int kUnits = 300;
  for (setup.seed = 1; setup.seed <= kUnits; ++setup.seed) {
    const auto constant = link_of("turn_on_bias", setup), ramp = link_of("ramp", setup),
               warm = link_of("temperature", setup), shaken = link_of("vibration_rectification", setup);
    const auto from = still(500);
    const bool all = setup.seed < 4;  // of the others what tells their draws
    const auto first = all ? from : still(1);
    const auto b = added(*constant, 0, first), r = added(*ramp, 0, first), v = added(*shaken, 0, first),
               w = added(*warm, 0, all ? in : std::vector<Increments>{in[0], in[1]});
    std::vector<double> row;
    for (std::size_t t = 0; t < 2; ++t)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        row.push_back(b[0][t][axis] / (kTurnOn[t] * kStep_s));
        // Two samples at one temperature tell bias and gain apart.
        const double x0 = in[0][t][axis], x1 = in[1][t][axis], above_k = -31.0;
        const double gain = (w[1][t][axis] - w[0][t][axis]) / (x1 - x0) / above_k,
                     bias = w[0][t][axis] / above_k - gain * x0;
        row.push_back(bias / (kPerK[t] * kStep_s)), row.push_back(gain / kGain[t]);
        const double slope = r[0][t][axis] / (0.5 * kStep_s * kStep_s);
        looks.near(std::abs(slope) / kSlope[t], 1.0, 8.0 * kEpsilon);
        const double square =
            t == 0 ? 9.0 + 25.0 + 121.0
                   : setup.environment.vibration_rms_m_s2[axis] * setup.environment.vibration_rms_m_s2[axis];
        looks.near(std::abs(v[0][t][axis]) / (kRectified[t] * square * kStep_s), 1.0, 8.0 * kEpsilon);
        const std::size_t place = 3 * t + static_cast<std::size_t>(axis);
        positive[place] += slope > 0.0 ? 1.0 : 0.0, positive[6 + place] += v[0][t][axis] > 0.0 ? 1.0 : 0.0;
        if (!all) continue;
        for (std::size_t k = 0; k < 500; ++k) {
          const double middle_s = kStep_s * (static_cast<double>(k) + 0.5);
          looks.right(b[k][t][axis] == b[0][t][axis] && v[k][t][axis] == v[0][t][axis]);
          looks.close(r[k][t][axis], slope * middle_s * kStep_s, 16.0);
          // Of gain and bias from two samples of like size.
          looks.near(w[k][t][axis], (temperature(middle_s) - 21.0) * (bias + gain * in[k][t][axis]),
                     1e4 * kEpsilon * kStep_s * (1.0 + std::abs(x0 / (x1 - x0))));
        }
      }
    normals.take(row);
  }
  normals.look(looks);
  for (const double p : positive) looks.near(p / kUnits, 0.5, 5.0 * 0.5 / std::sqrt(1.0 * kUnits));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> input_link_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "links of the error chain that act on the input",
           "an axis's draw for another's, a figure of the other triad, a sign of one direction only",
           "their law for any input to roundings, and draws over 300 units: five deviations", "of the bound"});
  rows.add("links/misalignment",
           [] { return matrix_link("misalignment", &TriadFigures::misalignment_rad, 3e-3, 7e-3); });
  rows.add("links/package", [] { return matrix_link("package_misalignment", &TriadFigures::package_rad, 0.05, 0.2); });
  rows.add("links/scale_factor", [] { return matrix_link("scale_factor", &TriadFigures::scale, 2e-3, 5e-4); });
  rows.add("links/cross_talk", [] { return matrix_link("cross_talk", &TriadFigures::cross_talk, 0.02, 0.01); });
  rows.add("links/g_sensitivity", [] { return matrix_link("g_sensitivity", &TriadFigures::g_sensitivity, 1e-3, 0.0); });
  rows.add("links/curves", curved_links).add("links/stated_biases", stated_biases);
  return rows.take();
}

}  // namespace canyon::inertial
