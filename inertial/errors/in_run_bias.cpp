#include "inertial/errors/block_noise.h"
#include "inertial/errors/error_link.h"
#include "inertial/errors/markov_process.h"
#include "inertial/errors/white_draws.h"

namespace canyon::inertial {
namespace {

/// First-order Gauss-Markov bias, integrated over each sample's interval without discretization error.
class InRunBias {
 public:
  explicit InRunBias(const TriadSetup& s)
      : process_(MarkovProcess::gauss_markov(s.unit.seed, s.name + ".in_run", 0, s.figures.in_run_bias * s.unit.dt_s,
                                             s.figures.in_run_bias_tau_s, s.unit.dt_s)),
        within_(s.unit.seed, s.name + ".in_run.within") {}
  static bool needed(const TriadFigures& f) { return f.in_run_bias > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      process_.add_means(number, errors);
      if (process_.within_sigma() > 0.0) add_white(within_, process_.within_sigma(), number, errors);
    });
  }

 private:
  MarkovProcess process_;  // of the increment: bias times interval
  RandomStream within_;
  BlockNoise noise_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_in_run_bias(const LinkSetup& setup) {
  return make_for_both_triads<InRunBias>(setup);
}

}  // namespace canyon::inertial
