#include "canyon/inertial/error_chain.h"

#include <algorithm>

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

constexpr ErrorChainRow kRows[] = {
    {"datasheet", make_datasheet_chain, true,
     "turn-on bias, Gauss-Markov in-run bias, scale factor, misalignment and white noise of the data sheet"},
    {"full", make_full_chain, true, "every link that the unit has figures for"},
    {"physics", make_physics_chain, true,
     "proof masses, thermally excited, pick-offs, filters and front ends; then the other links of \"full\""},
    {"white_only", make_white_only_chain, true, "the same unit's white noise and nothing else: a perfect calibration"},
    {"paper", make_paper_chain, false,
     "the chain of Durst & Goodin 2012 with its slips of units and its recursion corrected"},
    {"paper_as_printed", make_paper_as_printed_chain, false, "the chain of Durst & Goodin 2012 exactly as printed"},
    {"none", make_ideal_chain, false, "no error"},
};

Error unknown(const std::string& key, const std::string& what, const std::string& name,
              const std::vector<std::string>& known) {
  std::string expected = nearest_word(name, known);
  if (expected.empty()) {
    for (const std::string& word : known) expected += (expected.empty() ? "one of " : ", ") + word;
  } else {
    expected = "\"" + expected + "\"?";
  }
  return Error{.file = "", .key = key, .what = "no " + what + " \"" + name + "\"", .expected = expected};
}

}  // namespace

std::span<const ErrorChainRow> error_chains() {
  return kRows;
}

std::vector<std::string> error_chain_names() {
  std::vector<std::string> names;
  for (const ErrorChainRow& row : kRows) names.emplace_back(row.name);
  return names;
}

Result<std::unique_ptr<ErrorChain>> make_error_chain(const std::string& name, const ChainSetup& setup) {
  const auto row = std::find_if(std::begin(kRows), std::end(kRows), [&](const auto& r) { return name == r.name; });
  if (row == std::end(kRows)) return unknown("imu.errors", "error chain", name, error_chain_names());
  for (const std::string& link : setup.leave_out) {
    const std::vector<std::string> links = error_link_names();
    if (std::find(links.begin(), links.end(), link) == links.end()) {
      return unknown("imu.leave_out", "link", link, links);
    }
    if (!row->has_links) {
      return Error{.file = "",
                   .key = "imu.leave_out",
                   .what = "the error chain \"" + name + "\" has no links to leave out",
                   .expected = "an empty list, or errors = \"datasheet\", \"full\", \"physics\" or \"white_only\""};
    }
  }
  return row->make(setup);
}

Result<std::unique_ptr<ErrorChain>> make_ideal_chain(const ChainSetup&) {
  return std::unique_ptr<ErrorChain>(std::make_unique<IdealChain>());
}

}  // namespace canyon::inertial
