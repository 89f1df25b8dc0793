#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/config/config.h"

namespace canyon::gnss {

/// A receiver of the catalogue, gnss/receivers/NAME.toml: the keys of [gnss] that say what a receiver is and does, each
/// with `KEY_source`, where that figure was read, or that it is assumed.
struct ReceiverSheet {
  std::string name, description;
  ConfigNode figures;                                        ///< a table of keys of [gnss], checked
  std::vector<std::pair<std::string, std::string>> sources;  ///< of each figure, by key
};

/// Names of the built-in receivers, sorted.
std::vector<std::string> receiver_names();

/// A built-in receiver by name, or a file if `receiver` ends in ".toml". Errors name the file; an unknown name is an
/// error of `gnss.receiver` that names the nearest. Keys that are no figure of a receiver, values that their keys do
/// not take, figures and sources that are missing and figures that contradict one another are told at once, in one
/// line.
Result<ReceiverSheet> load_receiver(const std::string& receiver);
Result<ReceiverSheet> parse_receiver(std::string_view toml, const std::string& file_name);

/// Lays `over`, a mission's layer, on `tree`; the figures of the receiver that `over` names in gnss.receiver come
/// first, so that they replace what was set below and give way to what stands beside the name. A file that cannot be
/// read is an error of `gnss.receiver` where `over` names it.
Status lay_with_receiver(ConfigNode& tree, const ConfigNode& over);

}  // namespace canyon::gnss
