#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace canyon {

/// The temporary files and directories that this process has at the moment, so that an interruption can take them away
/// while the thread that writes them is still busy.
void add_litter(const std::string& path, const std::vector<std::string>& created_parents);
void forget_litter(const std::string& path);

/// A child process that works in such a directory: an interruption ends it, and all of its group, before it removes
/// any. For who holds hold_litter().
void add_litter_process(int process);
void forget_litter_process(int process);

/// Held while outputs get their final names: an interruption finds all of them in place or none.
std::unique_lock<std::mutex> hold_litter();
/// Within hold_litter(): from here on something stands under its final name.
void note_committed();
bool anything_committed();

/// Ends the children, removes all of it, and lets no output get its final name any more: the process is about to end.
void remove_litter_for_good();

/// Removes empty directories from the innermost on; one that has got other content meanwhile stays.
void remove_empty_directories(const std::vector<std::string>& outermost_first);

}  // namespace canyon
