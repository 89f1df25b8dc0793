#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "canyon/apps/options/mission_options.h"
#include "canyon/study/tradeoff/choosing/question.h"
#include "canyon/study/tradeoff/recorded/recorded_drive.h"
#include "canyon/study/tradeoff/tradeoff.h"

namespace canyon::apps {

/// As `canyon tradeoff` is called.
struct TradeoffCall {
  MissionOptions mission;
  study::TapeChoice tape;
  std::string recording, parts, fidelity = "high", tolerance, figure = "position_error_rms_m", write;
  std::optional<double> budget_cpu_s;
  std::int64_t samples = 60, repetitions = 5, seeds = 3;
  std::optional<std::int64_t> validate;  ///< none: as AskedTradeoff has it
  std::optional<double> question_s;      ///< none: as study::TradeoffOptions has it
  std::string outputs = "outcome,position,map,clouds";
};
void declare_tradeoff_options(Arguments& arguments, TradeoffCall& call);

/// What that asks for. Not to be copied: `options` point to the recording.
struct AskedTradeoff {
  study::TradeoffOptions options;
  std::unique_ptr<const study::RecordedDrive> recording;  ///< nullptr: none is given
  std::optional<study::Question> question;
  int validate = 20;  ///< seeds that have not chosen the answer, and that it must hold on
};
Result<AskedTradeoff> asked_tradeoff(const TradeoffCall& call);

}  // namespace canyon::apps
