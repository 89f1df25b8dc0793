#include "canyon/study/drive_check/drive_score.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/study/drive_check/drive_resampling.h"

namespace canyon::study {
namespace {

constexpr double kGuard_s = 5.0, kAlike_rad = 5.0 * kDegree;
constexpr int kResamples = 2000;

/// Draws, sorted, with what of the score does not depend on what came.
class Draws {
 public:
  explicit Draws(std::vector<double> values) : values_(std::move(values)) {
    std::sort(values_.begin(), values_.end());
    sums_.push_back(0.0);
    const auto n = static_cast<double>(values_.size());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      sums_.push_back(sums_.back() + values_[i]);
      apart_ += (2.0 * static_cast<double>(i) + 1.0 - n) * values_[i];
    }
    if (n > 1.0) apart_ /= n * (n - 1.0);
  }
  std::size_t size() const { return values_.size(); }
  double score(double came) const {
    const auto below =
        static_cast<std::size_t>(std::lower_bound(values_.begin(), values_.end(), came) - values_.begin());
    const auto k = static_cast<double>(below), n = static_cast<double>(values_.size());
    const double distance = k * came - sums_[below] + (sums_.back() - sums_[below]) - (n - k) * came;
    return distance / n - apart_;
  }

 private:
  std::vector<double> values_, sums_;
  double apart_ = 0.0;  ///< half the mean distance of two
};

using Key = std::pair<std::int64_t, SatelliteId>;

struct Foretold {
  std::map<Key, std::vector<double>> of_signal;
  std::vector<double> of_kind[2];
};

/// Of an instant, whole tenths of a second: clocks of receivers run off by milliseconds.
std::int64_t instant(GpsTime t) {
  return (t.ns + 50'000'000) / 100'000'000;
}

Foretold gather_draws(const std::vector<std::vector<DriveEpoch>>& draws) {
  Foretold out;
  for (const auto& epochs : draws)
    for (const DriveEpoch& epoch : epochs)
      for (const DriveSignal& s : epoch.signals) {
        if (!std::isfinite(s.error_m)) continue;
        out.of_signal[{instant(epoch.t), s.sv}].push_back(s.error_m);
        out.of_kind[s.in_sight ? 1 : 0].push_back(s.error_m);
      }
  return out;
}

/// What was measured outside of a block and the guard about it.
struct Elsewhere {
  std::vector<double> error_m, elevation_rad;

  Elsewhere(const std::vector<DriveEpoch>& epochs, GpsTime start, int block) {
    for (const DriveEpoch& epoch : epochs) {
      const double since_s = (epoch.t - start) - block * kDriveBlock_s;
      if (since_s > -kGuard_s && since_s < kDriveBlock_s + kGuard_s) continue;
      for (const DriveSignal& s : epoch.signals) {
        if (!std::isfinite(s.error_m)) continue;
        error_m.push_back(s.error_m);
        elevation_rad.push_back(s.elevation_rad);
      }
    }
  }
  Draws alike(double el_rad) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < error_m.size(); ++i)
      if (std::abs(elevation_rad[i] - el_rad) <= kAlike_rad) out.push_back(error_m[i]);
    return Draws(out.size() > 1 ? out : error_m);
  }
};

struct BlockSums {
  double n = 0.0, simulation = 0.0, blind = 0.0, elevation = 0.0;
};

std::array<double, 2> interval(const std::vector<BlockSums>& blocks, double BlockSums::*other, std::uint64_t seed) {
  const RandomStream stream(seed, "study.drive_check.score");
  std::vector<double> differences;
  for (int k = 0; k < kResamples; ++k) {
    double n = 0.0, sum = 0.0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const double u = stream.uniform(static_cast<std::uint32_t>(b), static_cast<std::uint64_t>(k));
      const BlockSums& one =
          blocks[std::min(static_cast<std::size_t>(u * static_cast<double>(blocks.size())), blocks.size() - 1)];
      n += one.n;
      sum += one.simulation - one.*other;
    }
    if (n > 0.0) differences.push_back(sum / n);
  }
  std::sort(differences.begin(), differences.end());
  const auto at = [&](double p) { return differences[static_cast<std::size_t>(p * (differences.size() - 1.0))]; };
  return {at(0.025), at(0.975)};
}

}  // namespace

double crps(const std::vector<double>& draws, double came) {
  return Draws(draws).score(came);
}

DriveScore drive_score(const std::vector<DriveEpoch>& measured, const std::vector<std::vector<DriveEpoch>>& draws,
                       std::uint64_t seed) {
  DriveScore out;
  out.draws = static_cast<int>(draws.size());
  if (measured.empty() || draws.empty()) return out;
  const Foretold foretold = gather_draws(draws);
  const Draws kinds[2] = {Draws(foretold.of_kind[0]), Draws(foretold.of_kind[1])};
  const GpsTime start = measured.front().t;
  const int count = drive_block(measured.back().t, start) + 1;
  std::vector<BlockSums> blocks(static_cast<std::size_t>(count));
  double known = 0.0;
  for (int b = 0; b < count; ++b) {
    throw_if_cancelled();
    const Elsewhere elsewhere(measured, start, b);
    if (elsewhere.error_m.size() < 2) return out;
    const Draws blind(elsewhere.error_m);
    std::map<int, Draws> by_elevation;  // whole degrees
    BlockSums& sums = blocks[static_cast<std::size_t>(b)];
    for (const DriveEpoch& epoch : measured) {
      if (drive_block(epoch.t, start) != b) continue;
      for (const DriveSignal& s : epoch.signals) {
        if (!std::isfinite(s.error_m) || kinds[s.in_sight ? 1 : 0].size() < 2) continue;
        const auto own = foretold.of_signal.find({instant(epoch.t), s.sv});
        const bool has = own != foretold.of_signal.end() && own->second.size() > 1;
        const int degrees = static_cast<int>(std::lround(s.elevation_rad / kDegree));
        auto alike = by_elevation.find(degrees);
        if (alike == by_elevation.end())
          alike = by_elevation.emplace(degrees, elsewhere.alike(degrees * kDegree)).first;
        sums.n += 1.0;
        sums.simulation += has ? crps(own->second, s.error_m) : kinds[s.in_sight ? 1 : 0].score(s.error_m);
        sums.blind += blind.score(s.error_m);
        sums.elevation += alike->second.score(s.error_m);
        known += has ? 1.0 : 0.0;
      }
    }
  }
  BlockSums all;
  for (const BlockSums& one : blocks) {
    all.n += one.n;
    all.simulation += one.simulation;
    all.blind += one.blind;
    all.elevation += one.elevation;
  }
  if (all.n == 0.0) return out;
  out.signals = static_cast<int>(all.n);
  out.foretold_share = known / all.n;
  out.simulation_m = all.simulation / all.n;
  out.blind_m = all.blind / all.n;
  out.elevation_m = all.elevation / all.n;
  out.against_blind_m = interval(blocks, &BlockSums::blind, seed);
  out.against_elevation_m = interval(blocks, &BlockSums::elevation, seed);
  return out;
}

}  // namespace canyon::study
