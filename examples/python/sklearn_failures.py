"""A rule for the machines that miss the goal, by a decision tree of scikit-learn.

usage: sklearn_failures.py RESULTS

X and y come from `trials`, which joins what was drawn with what came of it.
"""

import sys

import zerocount as zc
from sklearn.model_selection import StratifiedGroupKFold, cross_val_score
from sklearn.tree import DecisionTreeClassifier, export_text

INPUTS = ["k1", "k2", "beta", "alpha", "targets.0", "encoder_phase"]


def main(path):
    results = zc.open(path)
    trials = results.trials(results.best)
    x = trials[INPUTS]
    y = trials["goal_met"]
    tree = DecisionTreeClassifier(max_leaf_nodes=4, min_samples_leaf=10, class_weight="balanced", random_state=1)
    # The trials of a machine stay together: otherwise the tree would be tested on machines that it knows.
    folds = StratifiedGroupKFold(5).split(x, y, groups=trials["machine"])
    scores = cross_val_score(tree, x, y, cv=folds, scoring="balanced_accuracy")
    print(f"balanced accuracy on other machines: {scores.mean():.2f}")
    print(export_text(tree.fit(x, y), feature_names=INPUTS, decimals=1))


if __name__ == "__main__":
    main(sys.argv[1])
