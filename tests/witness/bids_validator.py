# SPDX-License-Identifier: Apache-2.0
"""npm's bids-validator on a folder: bids_validator.py NODE_MODULES FOLDER prints the keys of its errors."""
import json
import subprocess
import sys

done = subprocess.run(["node", sys.argv[1] + "/bids-validator/bin/bids-validator", sys.argv[2], "--json"],
                      capture_output=True, text=True)
issues = json.loads(done.stdout)["issues"]
print("".join(f"{issue['key']}: {issue['files'][0].get('evidence', '')}\n" for issue in issues["errors"]), end="")
