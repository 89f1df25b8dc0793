#include "canyon/inertial/error_chain.h"

#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

class IdealChain final : public ErrorChain {
 public:
  void corrupt(std::int64_t, ImuSample&) override {}
  const ImuNoise& noise() const override { return noise_; }

 private:
  ImuNoise noise_;
};

constexpr ModelRow<ErrorChainModel> kRows[] = {
    {"datasheet",
     {make_datasheet_chain, true},
     "turn-on bias, Gauss-Markov in-run bias, scale factor, misalignment and white noise of the data sheet"},
    {"full", {make_full_chain, true}, "every link that the unit has figures for"},
    {"physics",
     {make_physics_chain, true},
     "proof masses, thermally excited, pick-offs, filters and front ends; then the other links of \"full\""},
    {"white_only",
     {make_white_only_chain, true},
     "the same unit's white noise and nothing else: a perfect calibration"},
    {"paper",
     {make_paper_chain, false},
     "the chain of Durst & Goodin 2012 with its slips of units and its recursion corrected"},
    {"paper_as_printed", {make_paper_as_printed_chain, false}, "the chain of Durst & Goodin 2012 exactly as printed"},
    {"none", {make_ideal_chain, false}, "no error"},
};

}  // namespace

ModelTable<ErrorChainModel> error_chains() {
  return kRows;
}

Result<std::unique_ptr<ErrorChain>> make_error_chain(const std::string& name, const ChainSetup& setup) {
  CANYON_TRY(const auto* row, choose(error_chains(), name, "imu.errors"));
  for (const std::string& link : setup.leave_out) {
    CANYON_TRY_STATUS(choose(error_links(), link, "imu.leave_out"));
    if (!row->make.has_links) {
      return Error{.file = "",
                   .key = "imu.leave_out",
                   .what = "the error chain \"" + name + "\" has no links to leave out",
                   .expected = "an empty list, or imu.errors = \"datasheet\", \"full\", \"physics\" or \"white_only\""};
    }
  }
  return row->make.make(setup);
}

Result<std::unique_ptr<ErrorChain>> make_ideal_chain(const ChainSetup&) {
  return std::unique_ptr<ErrorChain>(std::make_unique<IdealChain>());
}

}  // namespace canyon::inertial
