# SPDX-License-Identifier: Apache-2.0
"""SciPy's Wilcoxon test (exact; by the normal distribution), quantiles, and a bootstrap of the mean."""
from arrays import answer, given
import numpy as np
from scipy.stats import bootstrap, wilcoxon

d, ties = given("differences"), given("ties")
exact, normal = wilcoxon(d, mode="exact"), wilcoxon(ties, mode="approx")
answer("tests", [exact.statistic, exact.pvalue, normal.statistic, normal.pvalue])
answer("quantiles", np.quantile(d, [0, 0.025, 0.5, 0.77, 1]))
interval = bootstrap((d,), np.mean, n_resamples=20000, method="percentile", random_state=1).confidence_interval
answer("interval", [d.mean(), *interval])
