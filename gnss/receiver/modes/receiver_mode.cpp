#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

/// Every delay acts in full and nothing is subtracted: the paper's off-the-shelf receiver.
class SingleUncorrected final : public ReceiverMode {
 public:
  Correction correction(const CorrectionInput&) const override { return {}; }
  FixStatus status() const override { return FixStatus::kSingle; }
  bool corrects_atmosphere() const override { return false; }
};

/// The paper's semantics of a dual-band receiver: "the Ionosphere error is removed", at no cost; the rest acts in full.
class DualPaper final : public ReceiverMode {
 public:
  RangeDelays acting(const RangeDelays& raw) const override { return {0.0, raw.troposphere_m, raw.ephemeris_m}; }
  Correction correction(const CorrectionInput&) const override { return {}; }
  FixStatus status() const override { return FixStatus::kSingle; }
  bool corrects_atmosphere() const override { return false; }
};

/// The paper's semantics of DGPS: "only the Troposphere errors will have an effect on the receiver-SV range"; they act
/// in full.
class DgpsPaper final : public ReceiverMode {
 public:
  RangeDelays acting(const RangeDelays& raw) const override { return {0.0, raw.troposphere_m, 0.0}; }
  Correction correction(const CorrectionInput&) const override { return {}; }
  FixStatus status() const override { return FixStatus::kDifferential; }
  bool corrects_atmosphere() const override { return false; }
};

/// What acting() takes away before it acts.
Need taken_away(const char* effect) {
  return {.effect = effect, .verdict = Verdict::kNotNeeded, .bound_unit = "m", .reason = "this mode removes it whole"};
}
std::vector<Need> dual_paper_needs(const ModelParameters&, const DelayQuestion&) {
  return {taken_away(kIonosphere)};
}
std::vector<Need> dgps_paper_needs(const ModelParameters&, const DelayQuestion&) {
  return {taken_away(kIonosphere), taken_away(kEphemeris)};
}

std::unique_ptr<ReceiverMode> make_single_uncorrected(const ModelParameters&, const ReceiverModeSetup&) {
  return std::make_unique<SingleUncorrected>();
}
std::unique_ptr<ReceiverMode> make_dual_paper(const ModelParameters&, const ReceiverModeSetup&) {
  return std::make_unique<DualPaper>();
}
std::unique_ptr<ReceiverMode> make_dgps_paper(const ModelParameters&, const ReceiverModeSetup&) {
  return std::make_unique<DgpsPaper>();
}

void base_parameters(ModelParameters& section) {
  section.add<DgpsParameters>();
  section.add<BaseStationParameters>();
}

constexpr ModelRow<MakeReceiverMode> kModes[] = {
    {"single", make_single,
     "stand-alone: subtracts an ionosphere model and a standard troposphere (residual atmosphere)",
     parameters_of<SingleFrequencyParameters>},
    {"single_uncorrected", make_single_uncorrected,
     "stand-alone as in the paper: every delay acts in full (raw atmosphere)"},
    {"dual", make_dual,
     "two frequencies: ionosphere-free combination with its noise, standard troposphere subtracted (residual "
     "atmosphere)",
     parameters_of<SingleFrequencyParameters>},
    {"dual_paper",
     {make_dual_paper, dual_paper_needs},
     "the paper's dual band: no ionosphere, the rest acts in full (raw atmosphere)"},
    {"dgps",
     {make_dgps, dgps_needs},
     "differential: what the base station sees is subtracted, residuals grow with the baseline (residual atmosphere)",
     parameters_of<DgpsParameters>},
    {"dgps_base", make_base,
     "differential: the base station is simulated too, and its corrections subtracted (residual atmosphere)",
     base_parameters},
    {"dgps_paper",
     {make_dgps_paper, dgps_paper_needs},
     "the paper's differential mode: only the troposphere acts, in full (raw atmosphere)"},
};

}  // namespace

ModelTable<MakeReceiverMode> receiver_modes() {
  return kModes;
}

}  // namespace canyon::gnss
