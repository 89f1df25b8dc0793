// A filter whose models are those of the world it is in is as far off as it says: every state block, every measurement.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/fusion/consistency.h"
#include "canyon/tests/fusion/matched_world.h"
#include "canyon/tests/fusion/nees_bands.h"

namespace canyon::fusion {
namespace {

using testing::MatchedWorld;

constexpr int kModelRuns = 100, kEpochs = 20;
constexpr double kEpoch_s = 5.0;

TEST(MatchedModels, EveryBlockIsAsFarOffAsItSays) {
  testing::BlockNees nees(kEpochs);
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
        nees.add(name, epoch, normalized_squared(error, P.block(at, at, n, n)), static_cast<int>(n));
      }
      nees.add("all", epoch, normalized_squared(all, P), static_cast<int>(P.rows()));
    }
  }
  nees.expect_in_bands(kModelRuns);
}

}  // namespace
}  // namespace canyon::fusion
