// A filter whose models are those of the world it is in is as far off as it says: every state block, every measurement.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/fusion/consistency.h"
#include "canyon/tests/fusion/matched_world.h"

namespace canyon::fusion {
namespace {

using testing::MatchedWorld;

constexpr int kModelRuns = 100, kEpochs = 20;
constexpr double kEpoch_s = 5.0;

TEST(MatchedModels, EveryBlockIsAsFarOffAsItSays) {
  std::map<std::string, std::array<ConsistencyMean, kEpochs>> means;
  std::map<std::string, int> degrees;
  for (int run = 0; run < kModelRuns; ++run) {
    MatchedWorld world(static_cast<std::uint64_t>(run) + 1);
    ErrorStateFilter filter = world.filter();
    for (int epoch = 0; epoch < kEpochs; ++epoch) {
      for (int k = 0; k < static_cast<int>(100 * kEpoch_s); ++k) world.step(filter);
      const Eigen::MatrixXd P = filter.covariance();
      Eigen::VectorXd all(P.rows());
      for (const auto& [name, error] : world.errors(filter)) {
        const int at = name == "theta" ? 0 : name == "p" ? 3 : name == "v" ? 6 : filter.offset(name);
        const auto n = error.size();
        all.segment(at, n) = error;
        means[name][static_cast<std::size_t>(epoch)].add(normalized_squared(error, P.block(at, at, n, n)),
                                                         static_cast<int>(n));
        degrees[name] = static_cast<int>(n);
      }
      means["all"][static_cast<std::size_t>(epoch)].add(normalized_squared(all, P), static_cast<int>(P.rows()));
      degrees["all"] = static_cast<int>(P.rows());
    }
  }
  // 20 epochs of 13 blocks: one false alarm in four tries at 1e-3 each, so the seeds are fixed.
  for (const auto& [name, epochs] : means) {
    const int dof = degrees[name];
    const Band band = mean_chi_square_band(dof, kModelRuns, 1e-3);
    std::printf("%-15s NEES per state", name.c_str());
    for (const ConsistencyMean& mean : epochs) {
      std::printf(" %.2f", mean.per_state());
      EXPECT_TRUE(band.contains(mean.per_state() * dof))
          << name << ": " << mean.per_state() << " in " << band.low / dof << " .. " << band.high / dof;
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace canyon::fusion
