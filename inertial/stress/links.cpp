// Each link of the error chain by itself: what it adds to an input, against its law, and over many units the size that
// its figure says.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/flicker.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

constexpr double kStep_s = 0.02;
constexpr auto kBlock = static_cast<std::int64_t>(kImuBlock);

/// Increments of both triads, gyroscope first.
using Increments = std::array<Vector3d, 2>;

std::unique_ptr<ErrorLink> link_of(const std::string& name, const LinkSetup& setup) {
  return model_row(error_links(), name).make(setup);
}

/// What the link makes of these samples, as a chain hands them over: never over the border of a block.
std::vector<Increments> through(ErrorLink& link, std::int64_t first, const std::vector<Increments>& in,
                                std::vector<ImuSample>* samples = nullptr) {
  std::vector<Increments> out;
  std::vector<ImuSample> stamped(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    stamped[i].t = tick({}, first + static_cast<std::int64_t>(i) + 1, 1.0 / kStep_s);
    stamped[i].dt_s = kStep_s;
  }
  const auto block = std::make_unique<ImuBlock>();
  for (std::size_t begin = 0; begin < in.size(); begin += block->count) {
    block->first = first + static_cast<std::int64_t>(begin);
    block->count = std::min(in.size() - begin, static_cast<std::size_t>(kBlock - block->first % kBlock));
    block->samples = std::span(stamped).subspan(begin, block->count);
    for (std::size_t i = 0; i < block->count; ++i)
      for (std::size_t t = 0; t < 2; ++t)
        for (std::size_t axis = 0; axis < 3; ++axis)
          block->triads[t].truth[axis][i] = block->triads[t].output[axis][i] =
              in[begin + i][t][static_cast<Eigen::Index>(axis)];
    link.apply(*block);
    for (std::size_t i = 0; i < block->count; ++i) {
      Increments x;
      for (std::size_t t = 0; t < 2; ++t)
        for (std::size_t axis = 0; axis < 3; ++axis)
          x[t][static_cast<Eigen::Index>(axis)] = block->triads[t].output[axis][i];
      out.push_back(x);
    }
  }
  if (samples != nullptr) *samples = stamped;
  return out;
}

/// What it adds.
std::vector<Increments> added(ErrorLink& link, std::int64_t first, const std::vector<Increments>& in) {
  auto out = through(link, first, in);
  for (std::size_t i = 0; i < in.size(); ++i)
    for (std::size_t t = 0; t < 2; ++t) out[i][t] -= in[i][t];
  return out;
}

std::vector<Increments> still(std::size_t count) {
  return std::vector<Increments>(count, Increments{Vector3d::Zero(), Vector3d::Zero()});
}

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

/// Variance of the sum of m samples from sample `first` on.
using SumVariance = std::function<double(const TriadFigures& figures, double first, double m)>;

/// Links of noise: the sum over m samples has the variance of the continuous process, from within a block and over its
/// border, for either triad; `together`: over how many samples noise hangs together. Five standard deviations.
StressFigure process_link(const std::string& name, const TriadFigures& gyro, const TriadFigures& accel, double together,
                          const SumVariance& variance) {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  setup.figures.gyro = gyro, setup.figures.accel = accel;
  constexpr int kUnits = 250;
  constexpr std::int64_t kFirst = kBlock;
  constexpr std::array<int, 4> kLengths = {1, 2, 5, 60};
  const std::vector<Increments> none = still(480);
  // By length, triad and place: sums from the block's beginning on, and products of neighbours.
  std::array<std::array<double, 2>, 4> squares{}, counts{};
  std::array<double, 2> mean{};
  double across = 0.0, crosses = 0.0;
  std::array<std::array<std::vector<double>, 2>, 4> expected;
  for (std::size_t l = 0; l < kLengths.size(); ++l)
    for (std::size_t t = 0; t < 2; ++t)
      for (int begin = 0; begin + kLengths[l] <= 480; begin += kLengths[l])
        expected[l][t].push_back(variance(t == 0 ? gyro : accel, static_cast<double>(kFirst) + begin, kLengths[l]));
  for (setup.seed = 1; setup.seed <= kUnits; ++setup.seed) {
    const auto link = link_of(name, setup);
    if (!link || link->memory() != 0) return {stress::kInfinity, 1.0};
    const auto e = through(*link, kFirst, none);
    for (std::size_t t = 0; t < 2; ++t)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        mean[t] += e[100][t][axis] / (3.0 * kUnits);
        for (std::size_t l = 0; l < kLengths.size(); ++l) {
          const int m = kLengths[l];
          for (int begin = 0; begin + m <= 480; begin += m) {
            double sum = 0.0;
            for (int i = begin; i < begin + m; ++i) sum += e[static_cast<std::size_t>(i)][t][axis];
            squares[l][t] += sum * sum / expected[l][t][static_cast<std::size_t>(begin / m)];
            counts[l][t] += 1.0;
          }
        }
      }
    // Axes and triads have nothing to do with one another.
    for (const std::size_t k : {std::size_t{3}, std::size_t{200}, std::size_t{300}}) {
      const double a = expected[0][0][k], b = expected[0][1][k];
      across += e[k][0].x() * e[k][0].y() / a + e[k][0].y() * e[k][0].z() / a + e[k][1].z() * e[k][1].x() / b +
                e[k][0].x() * e[k][1].x() / std::sqrt(a * b) + e[k][0].z() * e[k][1].z() / std::sqrt(a * b);
      crosses += 5.0;
    }
  }
  for (std::size_t l = 0; l < kLengths.size(); ++l)
    for (std::size_t t = 0; t < 2; ++t) {
      // Sums beside one another share a sample of noise, and what lasts.
      const double independent = 3.0 * kUnits * std::max(1.0, 480.0 / (2.0 * kLengths[l] + together));
      looks.near(squares[l][t] / counts[l][t], 1.0, 5.0 * std::sqrt(2.0 / independent));
    }
  for (std::size_t t = 0; t < 2; ++t)
    looks.near(mean[t] / std::sqrt(expected[0][t][100]), 0.0, 5.0 / std::sqrt(3.0 * kUnits));
  looks.near(across / crosses, 0.0, 5.0 * std::sqrt(3.0 / crosses));
  return looks.figure();
}

/// Of a Gauss-Markov process of sigma and tau, integrated over m intervals.
double markov_sum(double sigma, double tau_s, double m) {
  const double x = m * kStep_s / tau_s;
  return 2.0 * sigma * sigma * tau_s * tau_s * (x + std::expm1(-x));
}

StressFigure white(double correlation) {
  TriadFigures gyro, accel;
  gyro.white_per_sqrt_hz = 0.3, accel.white_per_sqrt_hz = 2.0;
  gyro.neighbour_correlation = correlation, accel.neighbour_correlation = 0.6 * correlation;
  return process_link("white_noise", gyro, accel, 2.0, [](const TriadFigures& f, double, double m) {
    // Neighbours share rho of their variance, and the sum of many has N^2 t.
    const double each = f.white_per_sqrt_hz * f.white_per_sqrt_hz * kStep_s / (1.0 + 2.0 * f.neighbour_correlation);
    return each * (m + 2.0 * (m - 1.0) * f.neighbour_correlation);
  });
}

StressFigure quantized() {
  TriadFigures gyro, accel;
  gyro.quantization_noise = 1e-3, accel.quantization_noise = 0.02;
  return process_link("quantization_noise", gyro, accel, 2.0, [](const TriadFigures& f, double, double) {
    return 2.0 * f.quantization_noise * f.quantization_noise;
  });
}

StressFigure in_run(double tau_s) {
  TriadFigures gyro, accel;
  gyro.in_run_bias = 0.01, accel.in_run_bias = 0.2;
  gyro.in_run_bias_tau_s = tau_s, accel.in_run_bias_tau_s = 3.0 * tau_s;
  return process_link("in_run_bias", gyro, accel, 12.0 * tau_s / kStep_s, [](const TriadFigures& f, double, double m) {
    return markov_sum(f.in_run_bias, f.in_run_bias_tau_s, m);
  });
}

StressFigure flickering() {
  TriadFigures gyro, accel;
  gyro.bias_instability = 0.01, accel.bias_instability = 0.3;
  gyro.flicker_low_hz = 0.01, gyro.flicker_high_hz = 60.0, accel.flicker_low_hz = 0.2, accel.flicker_high_hz = 5.0;
  return process_link("flicker", gyro, accel, 480.0, [](const TriadFigures& f, double, double m) {
    double sum = 0.0;
    for (const FlickerPart& part : flicker_parts(f.bias_instability, f.flicker_low_hz, f.flicker_high_hz))
      sum += markov_sum(part.sigma, part.tau_s, m);
    return sum;
  });
}

StressFigure walking() {
  TriadFigures gyro, accel;
  gyro.rate_random_walk = 0.02, accel.rate_random_walk = 0.5;
  return process_link("rate_random_walk", gyro, accel, 480.0, [](const TriadFigures& f, double first, double m) {
    // Of the walk until then, and of what it adds on the way: t^3 / 3.
    const double t = m * kStep_s;
    return f.rate_random_walk * f.rate_random_walk * (first * kStep_s * t * t + t * t * t / 3.0);
  });
}

/// Stamps: a skew that grows, jitter of the stated size about it, held within a quarter of an interval, and intervals
/// that are the stamps' own differences.
StressFigure stamps() {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  constexpr int kUnits = 400;
  double skewed = 0.0, jittered = 0.0, jitters = 0.0, held = 0.0, holds = 0.0;
  const auto in = still(300);
  for (setup.seed = 1; setup.seed <= kUnits; ++setup.seed) {
    std::vector<ImuSample> samples;
    setup.figures.clock_skew = 1e-4, setup.figures.clock_jitter_s = 0.0;
    through(*link_of("clock", setup), 1000, in, &samples);
    const double skew = (samples[0].t - GpsTime{}) / (1001.0 * kStep_s) - 1.0;
    skewed += std::pow(skew / 1e-4, 2) / kUnits;
    // A stamp is rounded to a nanosecond of 20 s.
    for (std::size_t i = 0; i < samples.size(); i += 37) {
      looks.near((samples[i].t - GpsTime{}) / ((1001.0 + static_cast<double>(i)) * kStep_s) - 1.0, skew, 1e-10);
      looks.near(samples[i].dt_s / kStep_s - 1.0, skew, 1e-10);
    }
    for (const double sigma_s : {1e-3, 0.05}) {
      setup.figures.clock_skew = 0.0, setup.figures.clock_jitter_s = sigma_s;
      through(*link_of("clock", setup), 250, in, &samples);
      double before_s = 0.0;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double off_s = (samples[i].t - GpsTime{}) - (251.0 + static_cast<double>(i)) * kStep_s;
        if (i > 0) looks.near(samples[i].dt_s - kStep_s, off_s - before_s, 1.1e-9);
        before_s = off_s;
        looks.right(std::abs(off_s) <= 0.25 * kStep_s + 1e-9);
        if (sigma_s == 1e-3) jittered += off_s * off_s, jitters += 1.0;
        if (sigma_s == 0.05) held += std::abs(off_s) > 0.25 * kStep_s - 1e-9 ? 1.0 : 0.0, holds += 1.0;
      }
    }
  }
  looks.near(skewed, 1.0, 5.0 * std::sqrt(2.0 / kUnits));
  // Held at 5 sigma: 6e-7 of them.
  looks.near(jittered / jitters / 1e-6, 1.0, 5.0 * std::sqrt(2.0 / jitters));
  // Beyond a tenth of sigma either way.
  const double beyond_it = std::erfc(0.1 / std::sqrt(2.0));
  looks.near(held / holds, beyond_it, 5.0 * std::sqrt(beyond_it * (1.0 - beyond_it) / holds));
  return looks.figure();
}

/// What is lost is lost in whole groups, none after another, never the first, and gives the last sample that came.
StressFigure groups_lost() {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 5, .dt_s = kStep_s};
  constexpr std::int64_t kLength = 4;
  setup.figures.loss_share = 0.2, setup.figures.loss_length = static_cast<double>(kLength);
  const auto link = link_of("losses", setup);
  looks.right(link->memory() == kLength + 1);
  std::vector<Increments> in;
  for (int k = 0; k < 1200; ++k) in.push_back({Vector3d(k, 2.0 * k, -k), Vector3d(-3.0 * k, k + 0.5, 7.0 * k)});
  std::vector<ImuSample> samples;
  const auto out = through(*link, 512, in, &samples);
  std::size_t last = 0;
  int run = 0;
  for (std::size_t k = 0; k < in.size(); ++k) {
    const auto number = 512 + static_cast<std::int64_t>(k);
    if (samples[k].lost) {
      looks.right(k > 0 && (run > 0 || k == 1 || number % kLength == 0));
      ++run;
    } else {
      looks.right(run == 0 || run == kLength || (run < kLength && k < kLength + 1));
      run = 0;
      last = k;
    }
    for (std::size_t t = 0; t < 2; ++t) looks.right(out[k][t] == in[last][t]);
  }
  looks.right(stress::not_refused([&] {
                setup.figures.loss_share = 0.3;
                link_of("losses", setup);
              }) == 0);
  return looks.figure();
}

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

std::vector<StressCase> link_cases() {
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
  rows.of({StressGroup::kData, "links of the error chain that are noise",
           "a density over the wrong interval, what is shared with the neighbour, a walk that does not begin at zero",
           "the variance of sums of 1 to 60 samples in closed form, five deviations of 250 units", "of the bound"});
  for (const double rho : {0.0, 0.3, 0.5})
    rows.add("links/white_noise_correlated_by_" + stress::text(rho), [rho] { return white(rho); });
  rows.add("links/quantization_noise", quantized);
  for (const double tau_s : {0.01, 0.3, 20.0})
    rows.add("links/in_run_bias_of_" + stress::text(tau_s) + "_s", [tau_s] { return in_run(tau_s); });
  rows.add("links/flicker", flickering).add("links/rate_random_walk", walking);
  rows.of({StressGroup::kData, "stamps and losses of a unit",
           "jitter of another sample, groups that follow one another",
           "their laws to a nanosecond, and shares to five deviations", "of the bound"});
  rows.add("links/stamps", stamps).add("links/groups_lost", groups_lost);
  rows.of({StressGroup::kData, "which links a unit has",
           "a link that another's figure brings, or a triad's that is bare",
           "none without figures, and with each its own alone: exact", "wrong"});
  rows.add("links/which_there_are", which_links);
  return rows.take();
}

}  // namespace canyon::inertial
