#pragma once

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/fusion/consistency.h"

namespace canyon::testing {

/// Normalized squared errors of a filter whose models are the world's: of each block of states at each epoch the mean
/// over runs.
class BlockNees {
 public:
  explicit BlockNees(int epochs) : epochs_(static_cast<std::size_t>(epochs)) {}

  void add(const std::string& block, int epoch, double nees, int dof) {
    std::vector<fusion::ConsistencyMean>& means = means_[block];
    means.resize(epochs_);
    means[static_cast<std::size_t>(epoch)].add(nees, dof);
    degrees_[block] = dof;
  }

  /// Each within its chi-square band, with a false alarm of 1e-3 each: of a hundred or so one in ten tries, so seeds
  /// are fixed.
  void expect_in_bands(int runs) const {
    for (const auto& [name, epochs] : means_) {
      const int dof = degrees_.at(name);
      const fusion::Band band = fusion::mean_chi_square_band(dof, runs, 1e-3);
      std::printf("%-15s NEES per state", name.c_str());
      for (const fusion::ConsistencyMean& mean : epochs) {
        std::printf(" %.2f", mean.per_state());
        EXPECT_TRUE(band.contains(mean.per_state() * dof))
            << name << ": " << mean.per_state() << " in " << band.low / dof << " .. " << band.high / dof;
      }
      std::printf("\n");
    }
  }

 private:
  std::size_t epochs_;
  std::map<std::string, std::vector<fusion::ConsistencyMean>> means_;
  std::map<std::string, int> degrees_;
};

}  // namespace canyon::testing
