#include <cmath>
#include <span>

#include "canyon/core/config/text.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"

namespace canyon::study {
namespace {

/// Empty where it is undefined.
std::string cell(double value) {
  return std::isfinite(value) ? number_text(value) : "";
}

std::string line_of(std::span<const std::string> cells) {
  std::string out;
  const char* apart = "";
  for (const std::string& one : cells) {
    out.append(apart).append(one);
    apart = ",";
  }
  return out + '\n';
}

std::string ties(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ";") + name;
  return out;
}

}  // namespace

std::string tradeoff_csv(const Tradeoff& tradeoff) {
  std::string out =
      "part,key,of,probe,model,error,error_unit,error_is,error_sigma,undefined_share,common_error,cpu_s_per_s,cpu_low_"
      "s_per_s,"
      "cpu_high_s_per_s,simulated_s,work,memory_mb,on_front,in_use,is_reference,resolved,tied_with,order_observed,"
      "order_theory,reference_error\n";
  for (const MeasuredLadder& ladder : tradeoff.ladders)
    for (const MeasuredModel& model : ladder.models) {
      const std::string cells[] = {ladder.part,
                                   ladder.key,
                                   ladder.of,
                                   ladder.probe,
                                   model.name,
                                   cell(model.error),
                                   ladder.unit,
                                   ladder.against_truth ? "error" : "difference to finest",
                                   cell(model.error_sigma),
                                   cell(model.undefined_share),
                                   cell(model.common_error),
                                   cell(model.cpu_s),
                                   cell(model.cpu_low_s),
                                   cell(model.cpu_high_s),
                                   cell(model.simulated_s),
                                   std::to_string(model.work),
                                   cell(model.memory_mb),
                                   model.on_front ? "1" : "0",
                                   model.in_use ? "1" : "0",
                                   model.is_reference ? "1" : "0",
                                   model.resolved ? "1" : "0",
                                   ties(model.tied_with),
                                   cell(ladder.order_observed),
                                   ladder.order_theory ? cell(*ladder.order_theory) : "",
                                   cell(ladder.reference_error)};
      out += line_of(cells);
    }
  return out;
}

std::string fidelities_csv(const Tradeoff& tradeoff) {
  std::string out =
      "fidelity,planned,position_error_rms_m,map_error_rms_m,registration_error_rms_m,tape_s,cpu_s_per_s,cpu_low_s_per_"
      "s,"
      "cpu_high_s_per_s,simulated_s,work,seeds,success,success_low,success_high,outcomes,mission_cpu_s,mission_cpu_low_"
      "s,"
      "mission_cpu_high_s\n";
  for (const MeasuredFidelity& run : tradeoff.fidelities) {
    const MeasuredOutcomes found = run.outcomes.value_or(MeasuredOutcomes{});
    std::string how;
    for (const auto& [outcome, count] : found.share.outcomes)
      how += (how.empty() ? "" : ";") + outcome + " " + std::to_string(count);
    const std::string cells[] = {run.name,
                                 run.planned ? "1" : "0",
                                 cell(run.position_error_rms_m),
                                 cell(run.map_error_rms_m),
                                 cell(run.registration_error_rms_m),
                                 cell(run.tape_s),
                                 cell(run.cpu_s),
                                 cell(run.cpu_low_s),
                                 cell(run.cpu_high_s),
                                 cell(run.simulated_s),
                                 std::to_string(run.work),
                                 std::to_string(found.share.n),
                                 std::to_string(found.share.success),
                                 cell(found.share.interval.low),
                                 cell(found.share.interval.high),
                                 how,
                                 cell(found.cpu_s),
                                 cell(found.cpu_low_s),
                                 cell(found.cpu_high_s)};
    out += line_of(cells);
  }
  return out;
}

}  // namespace canyon::study
