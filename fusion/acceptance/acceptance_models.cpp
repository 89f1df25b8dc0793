#include "canyon/fusion/acceptance/acceptance.h"

namespace canyon::fusion {
namespace {

class AcceptAll final : public Copied<Acceptance, AcceptAll> {
 public:
  Decision decide(const Innovation&) override { return {}; }
  bool takes_all() const override { return true; }
};

std::unique_ptr<Acceptance> make_accept_all() {
  return std::make_unique<AcceptAll>();
}

constexpr ModelRow<MakeAcceptance> kModels[] = {
    {"accept_all", without_keys<make_accept_all>, "every measurement, as it is"},
    {"gate", make_gate, "refuses what is too unlikely, and takes the filter for lost where it refuses all for long",
     gate_parameters},
    {"huber", make_huber, "what is far off counts as noisier, in proportion", huber_parameters},
    {"student_t", make_student_t, "what is far off counts as noisier, in proportion to its square",
     student_t_parameters},
    {"innovation_adaptive", make_innovation_adaptive, "noise as large as the last innovations say",
     innovation_adaptive_parameters},
    {"fuzzy_adaptive", make_fuzzy_adaptive, "noise raised by fuzzy rules on mean and size of the last innovations",
     fuzzy_adaptive_parameters},
};

}  // namespace

ModelTable<MakeAcceptance> acceptance_models() {
  return kModels;
}

}  // namespace canyon::fusion
