#include "canyon/study/plan/outputs.h"

#include <algorithm>

#include "canyon/core/model_table.h"

namespace canyon::study {

namespace {

constexpr ModelRow<Output> kOutputs[] = {
    {"outcome", Output::kOutcome, "how the mission ended"},
    {"position", Output::kPosition, "estimate, fixes and their errors"},
    {"map", Output::kMap, "figures of registration and maps"},
    {"clouds", Output::kClouds, "the scored maps as files"},
};

}  // namespace

const char* name(Output output) {
  return row_of(ModelTable<Output>(kOutputs), output).name;
}

Result<std::vector<Output>> outputs_of(const std::vector<std::string>& names, const std::string& option) {
  std::vector<Output> outputs;
  for (const std::string& asked : names) {
    const auto* row = find_model(ModelTable<Output>(kOutputs), asked);
    if (row == nullptr) {
      Error error = unknown_name("", asked, model_names(ModelTable<Output>(kOutputs)));
      error.file = option;
      return error;
    }
    if (!reads(outputs, row->make)) outputs.push_back(row->make);
  }
  return outputs;
}

std::vector<Output> all_outputs() {
  std::vector<Output> outputs;
  for (const auto& row : kOutputs) outputs.push_back(row.make);
  return outputs;
}

bool reads(const std::vector<Output>& outputs, Output one) {
  return std::find(outputs.begin(), outputs.end(), one) != outputs.end();
}

}  // namespace canyon::study
