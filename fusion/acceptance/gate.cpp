#include <algorithm>

#include "canyon/core/math/chi_square.h"
#include "canyon/fusion/acceptance/acceptance.h"
#include "canyon/fusion/consistency.h"

namespace canyon::fusion {
namespace {

struct GateParameters {
  double gate_sigma = 0.0;
  double gate_recovery_s = 10.0;
};
void visit(FieldVisitor& f, GateParameters& p) {
  f.number("gate_sigma", p.gate_sigma, {0, 20},
           "what is less likely than a deviation of this many sigma is refused; 0 accepts everything");
  f.number("gate_recovery_s", p.gate_recovery_s, {0, 1e6},
           "after so long with nothing but refusals the filter counts as lost and takes what comes; 0: never");
}

/// Without a way back a filter that is surer than right refuses the truth for ever.
class Gate final : public Copied<Acceptance, Gate> {
 public:
  explicit Gate(const GateParameters& p) : p_(p) {}
  void start() override { refused_ = 0; }
  bool takes_all() const override { return p_.gate_sigma == 0.0; }

  Decision decide(const Innovation& i) override {
    const int dof = static_cast<int>(i.residual.size());
    if (p_.gate_sigma == 0.0 || chi_square_tail(i.nis, dof) >= normal_two_sided_tail(p_.gate_sigma)) {
      refused_ = 0;
      return {};
    }
    if (refused_ == 0) since_ = i.t;
    ++refused_;
    const bool lost = p_.gate_recovery_s > 0.0 && refused_ >= kFewest && i.t - since_ >= p_.gate_recovery_s;
    if (!lost) return {.accepted = false};
    refused_ = 0;
    // As unsure as the innovation says: its normalized square becomes what is expected of it.
    return {.loosening = std::max(i.nis / dof, 1.0)};
  }

 private:
  static constexpr int kFewest = 5;

  GateParameters p_;
  int refused_ = 0;
  GpsTime since_;
};

}  // namespace

std::unique_ptr<Acceptance> make_gate(const ModelParameters& own) {
  return std::make_unique<Gate>(own.get<GateParameters>());
}

void gate_parameters(ModelParameters& section) {
  section.add<GateParameters>();
}

}  // namespace canyon::fusion
