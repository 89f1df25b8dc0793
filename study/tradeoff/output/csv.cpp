#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"

namespace canyon::study {
namespace {

/// Empty where it is undefined.
std::string cell(double value) {
  return std::isfinite(value) ? number_text(value) : "";
}

std::string ties(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ";") + name;
  return out;
}

}  // namespace

std::string tradeoff_csv(const Tradeoff& tradeoff) {
  std::string out =
      "part,key,of,probe,model,error,error_unit,error_is,error_sigma,undefined_share,cpu_s_per_s,cpu_low_s_per_s,"
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
      const char* apart = "";
      for (const std::string& one : cells) {
        out.append(apart).append(one);
        apart = ",";
      }
      out += '\n';
    }
  return out;
}

}  // namespace canyon::study
