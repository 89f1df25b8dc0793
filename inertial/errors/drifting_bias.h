#pragma once

#include "canyon/inertial/errors/block_noise.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/markov_process.h"
#include "canyon/inertial/errors/white_draws.h"

namespace canyon::inertial {

/// A bias that is one Markov process, integrated over each sample's interval without discretization error: what the
/// links of such biases have in common.
class DriftingBias {
 public:
  /// `process`: of the increment, bias times interval. `within`: what happens within an interval, given its ends.
  DriftingBias(MarkovProcess process, RandomStream within) : process_(std::move(process)), within_(within) {}

  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      process_.add_means(number, errors);
      if (process_.within_sigma() > 0.0) add_white(within_, process_.within_sigma(), number, errors);
    });
  }

 private:
  MarkovProcess process_;
  RandomStream within_;
  BlockNoise noise_;
};

}  // namespace canyon::inertial
