#pragma once

#include <filesystem>
#include <string>

namespace canyon {

/// The temporary name of an output: a hidden sibling of `path` (renaming stays within one file system), unlike that of
/// any other process on any host that shares the disk: `.NAME.ROLE-HOST-REALM-PID-START-N`. REALM stands for the boot
/// and the process namespace within which PID and START (the process's start in clock ticks) mean something; N counts.
std::filesystem::path staging_name(const std::filesystem::path& path, const char* role);

/// True only if the name is one of staging_name()'s and its process is provably gone: of this boot and namespace, and
/// no process of that number exists or it started at another time. Of another host's process nothing can be proved.
bool is_stale_staging_name(const std::string& name);

/// Removes from a folder what processes that were killed have left there: everything partial, and what had been
/// replaced where its successor stands. Whatever may belong to a living process stays. Failures are passed over.
void remove_stale_stagings(const std::filesystem::path& folder);

}  // namespace canyon
