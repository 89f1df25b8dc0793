#include "inertial/error_chain.h"

namespace canyon::inertial {
namespace {

class IdealChain final : public ErrorChain {
 public:
  void corrupt(std::int64_t, ImuSample&) override {}
  const ImuNoise& noise() const override { return noise_; }

 private:
  ImuNoise noise_;
};

constexpr ErrorChainRow kRows[] = {
    {"datasheet", make_datasheet_chain,
     "turn-on bias, Gauss-Markov in-run bias, scale factor, misalignment and white noise of the data sheet"},
    {"white_only", make_white_only_chain, "the same unit's white noise and nothing else: a perfect calibration"},
    {"paper", make_paper_chain, "the chain of Durst & Goodin 2012 with its slips of units and its recursion corrected"},
    {"paper_as_printed", make_paper_as_printed_chain, "the chain of Durst & Goodin 2012 exactly as printed"},
    {"none", make_ideal_chain, "no error"},
};

}  // namespace

std::span<const ErrorChainRow> error_chains() {
  return kRows;
}

std::vector<std::string> error_chain_names() {
  std::vector<std::string> names;
  for (const ErrorChainRow& row : kRows) names.emplace_back(row.name);
  return names;
}

Result<std::unique_ptr<ErrorChain>> make_ideal_chain(const CatalogueEntry&, std::uint64_t, double) {
  return std::unique_ptr<ErrorChain>(std::make_unique<IdealChain>());
}

}  // namespace canyon::inertial
