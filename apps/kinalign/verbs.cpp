// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs.h"

namespace kinalign {

/// All verbs, in the order of the help page.
std::vector<Verb> all_verbs() {
  // Verbs for files come first, then recording, data sets, learning, simulation and the lab's
  // services. The verbs about the program itself come last.
  return {align_verb(),
          info_verb(),
          check_verb(),
          report_verb(),
          convert_verb(),
          rebuild_verb(),
          record_verb(),
          recover_verb(),
          dataset_init_verb(),
          dataset_add_verb(),
          dataset_import_verb(),
          dataset_build_verb(),
          dataset_list_verb(),
          dataset_query_verb(),
          dataset_tables_verb(),
          dataset_report_verb(),
          dataset_verify_verb(),
          dataset_split_verb(),
          dataset_windows_verb(),
          dataset_export_verb(),
          dataset_rename_verb(),
          dataset_rm_verb(),
          train_verb(),
          denoise_verb(),
          pose_verb(),
          fuse_verb(),
          eval_verb(),
          benchmark_twin_verb(),
          benchmark_run_verb(),
          model_export_verb(),
          simulate_verb(),
          time_server_verb(),
          node_key_verb(),
          config_verb(),
          completion_verb(),
          man_verb()};
}

}  // namespace kinalign
