#include "canyon/inertial/errors/drifting_bias.h"

namespace canyon::inertial {
namespace {

/// First-order Gauss-Markov bias.
class InRunBias : public DriftingBias {
 public:
  explicit InRunBias(const TriadSetup& s)
      : DriftingBias(
            MarkovProcess::gauss_markov(s.unit.seed, s.name + ".in_run", 0, s.figures.in_run_bias * s.unit.dt_s,
                                        s.figures.in_run_bias_tau_s, s.unit.dt_s),
            RandomStream(s.unit.seed, s.name + ".in_run.within")) {}
  static bool needed(const TriadFigures& f) { return f.in_run_bias > 0.0; }
};

}  // namespace

std::unique_ptr<ErrorLink> make_in_run_bias(const LinkSetup& setup) {
  return make_for_both_triads<InRunBias>(setup);
}

}  // namespace canyon::inertial
