// SPDX-License-Identifier: Apache-2.0
// Declares all verbs, in the order of the help page. A new verb needs its own file, a line here and
// a line in verbs.cpp.
#pragma once

#include "apps/cli/verb.h"

#include <vector>

namespace kinalign {

/// Each function makes the description of one verb. Each run of a verb gets new options with their
/// defaults (make_verb in apps/cli/verb.h).
Verb align_verb();
Verb info_verb();
Verb check_verb();
Verb report_verb();
Verb convert_verb();
Verb rebuild_verb();
Verb record_verb();
Verb recover_verb();
Verb simulate_verb();
Verb dataset_init_verb();
Verb dataset_add_verb();
Verb dataset_import_verb();
Verb dataset_build_verb();
Verb dataset_list_verb();
Verb dataset_query_verb();
Verb dataset_tables_verb();
Verb dataset_verify_verb();
Verb dataset_split_verb();
Verb dataset_windows_verb();
Verb dataset_export_verb();
Verb dataset_report_verb();
Verb dataset_rename_verb();
Verb dataset_rm_verb();
Verb train_verb();
Verb denoise_verb();
Verb pose_verb();
Verb fuse_verb();
Verb eval_verb();
Verb benchmark_twin_verb();
Verb benchmark_run_verb();
Verb model_export_verb();
Verb time_server_verb();
Verb node_key_verb();
Verb config_verb();
Verb completion_verb();
Verb man_verb();

std::vector<Verb> all_verbs();

}  // namespace kinalign
