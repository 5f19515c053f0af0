"""The answers of the program, written by generate_answers.py from ``zerocount schema --answers``: do not edit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Protocol, Union, overload

from .answers import Answer, Record

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


class Cost(Record):
    """Computing time.

    Attributes
    ----------
    samples : float or None
        Samples of all trials.
    seconds_per_sample : float or None
        On one core, s.
    cores : int
        Cores of this machine.
    seconds : float or None
        With all cores, s.
    """

    samples: float | None
    seconds_per_sample: float | None
    cores: int
    seconds: float | None


class CheckAnswer(Answer):
    """The plan of a study, and the theory of its points.

    Attributes
    ----------
    name : str
        Name of the study.
    points : int
        Design points.
    trials : int
        Trials of each point, or the most of them.
    moves : int
        Moves of a trial.
    machine_count : int
        Number of machines at each point; 0: none.
    worlds : int
        Worlds; 0: none.
    conditions : list[str]
        Names of the conditions under which every machine runs; empty: none.
    judged_by : str or None
        What the moves are judged by; null without targets.
    stopping : pandas.DataFrame
        Trials that the stopping rule takes.

        - ``success_rate``: success rate of the trials
        - ``trials``: trials that the stopping rule takes, about
        - ``fixed``: trials for the same bounds, if fixed beforehand
        - ``ratio``: ratio of both

    cost : Cost
        Computing time.
    file_bytes : float or None
        Size of the results file, byte.
    disk_bytes : float or None
        Most space on the disk while it runs, byte.
    memory_bytes : float or None
        Most memory, byte.
    differ_in_trials : list[str]
        Inputs that differ between trials.
    differ_in_contacts : list[str]
        Of these, drawn at each contact.
    differ_in_machines : list[str]
        Inputs that differ between machines.
    differ_in_worlds : list[str]
        Inputs that differ between worlds.
    same_in_points : list[str]
        Inputs that differ between points only.
    sampled_together : str or None
        Inputs of a table of samples.
    correlated : str or None
        Correlated inputs.
    assumed_away : list[str]
        Effects of a real axis that the study leaves out without a word.
    stated_none : list[str]
        Effects of a real axis whose keys the manifest gives as 0.
    points_left_out : int
        Points without their theory here.
    theory : pandas.DataFrame
        Theory of the first points.

        - ``point``: number of the design point
        - ``label``: label of the design point
        - ``condition``: condition under which every machine runs
        - ``outside``: why (6) and (7) do not apply; null: they do
        - ``gain_name``: name of the integral gain
        - ``gain_unit``: unit of the gain and its bounds
        - ``gain``.* (low, high): integral gain
        - ``integral``: why there is no integral; null: there is one
        - ``criteria``: verdict of the paper's criteria (6) and (7)
        - ``criteria_trials``: trials that the criteria were tried in
        - ``criteria_stable``: trials in which (6) holds
        - ``criteria_unstable``: trials in which (7) is exceeded
        - ``sampled``: verdict of the sampled loop at k1, or without a spring
        - ``stable_below``.* (low, high): bound of criterion (6)
        - ``sampled_below``.* (low, high): bound of the sampled loop
        - ``unstable_above``.* (low, high): bound of criterion (7)
        - ``dac_resolution``.* (low, high): torque of a code of the DAC
        - ``dac_bound``.* (low, high): bound of the rule for the DAC
        - ``torque_unit``: unit of both
        - ``coarse_feedback``: whether the bound is of the coarse encoder
        - ``rule_trials``: trials that the rules were tried in
        - ``fine_enough``: trials in which the DAC satisfies its rule
        - ``fast_enough``: trials in which the sample rate satisfies its rule
        - ``natural_frequency``.* (low, high): natural frequency on k1 + k2, Hz
        - ``sample_rate``.* (low, high): sample rate, Hz
        - ``lowest_k1``: lowest stiffness k1 of the study
        - ``lowest_k1_source``: where it is from
        - ``lowest_stable_below``: bound of criterion (6) there, in the unit of the gain
        - ``lowest_sampled_below``: bound of the sampled loop there, in the unit of the gain
        - ``time_constant``.* (low, high): slowest time constant of the loop, s
        - ``hold``: time that the shortest move is held, s
        - ``longest_step``: length of the slowest move; 0: no step, count
        - ``longest_time``: time that it needs, with the dwell, s
        - ``exceeds_hold``: whether moves may end before they arrive
        - ``loops``: the loops in which the machine moves: at k1, at k1 + k2, at the ends of a profile and while the
          rotor slides, in each state of the load
          - ``loop``: where the rotor is
          - ``slides``: whether the rotor slides
          - ``stability``: stable, marginal or unstable: all that occur in the trials
          - ``slow``.* (low, high): slowest time constants longer than the hold, s
          - ``bandwidth``.* (low, high): bandwidth while it slides, Hz
          - ``gain_margin``.* (low, high): gain margin, dB
          - ``gain_margin_at``.* (low, high): frequency of the gain margin, Hz
          - ``phase_margin``.* (low, high): phase margin, °
          - ``phase_margin_at``.* (low, high): frequency of the phase margin, Hz
          - ``no_gain_stabilises``: whether the loop is unstable with every factor of its gain, in some trial
        - ``cut``: states of the load in which no encoder that the controller reads sees the motor
        - ``hunting``: what the longest move of trial 0 comes to
        - ``hunting_step``: length of that move, count
        - ``hunting_amplitude``: half of the range of its oscillation; null: it does not hunt, count
        - ``hunting_period``: period of the oscillation, s
        - ``hunting_mass``: mass that oscillates, motor or load; null: it does not hunt, or has one mass
        - ``hunting_duration``: time that was simulated to see it, s
        - ``targets``: targets of trial 0 in SI units, and their counts

    """

    _records = {"cost": Cost}

    name: str
    points: int
    trials: int
    moves: int
    machine_count: int
    worlds: int
    conditions: list[str]
    judged_by: str | None
    stopping: pandas.DataFrame
    cost: Cost
    file_bytes: float | None
    disk_bytes: float | None
    memory_bytes: float | None
    differ_in_trials: list[str]
    differ_in_contacts: list[str]
    differ_in_machines: list[str]
    differ_in_worlds: list[str]
    same_in_points: list[str]
    sampled_together: str | None
    correlated: str | None
    assumed_away: list[str]
    stated_none: list[str]
    points_left_out: int
    theory: pandas.DataFrame


class Unfinished(Record):
    """How far the run has come.

    Attributes
    ----------
    finished : int
        Trials that the summary is of.
    trials : int
        Trials of the study; the maximum if 'stop' decides.
    """

    finished: int
    trials: int


class Best(Record):
    """The point that the headline is of, and its competitors.

    Attributes
    ----------
    point : int
        Number of the design point.
    label : str
        Label of the design point.
    chosen_from : int
        Points that it is the best of; 1 if it was named.
    runner_up : int or None
        Number of the best of the other points.
    as_good : list[int]
        Numbers of the points that are not shown to be worse.
    ends_of_ranges : pandas.DataFrame
        Swept numbers of the point at an end of their range.

        - ``parameter``: dotted path
        - ``value``: value at the point, in the unit of the parameter
        - ``end``: which end of the range it is

    """

    point: int
    label: str
    chosen_from: int
    runner_up: int | None
    as_good: list[int]
    ends_of_ranges: pandas.DataFrame


class OtherMass(Record):
    """The same values of the load, which the goal of the motor does not limit.

    Attributes
    ----------
    of : str
        The mass.
    rate : float or None
        Proportion of its moves that meet the goal, with one-sided bounds.
    rate_low : float or None
        Lower bound.
    rate_high : float or None
        Upper bound.
    """

    of: str
    rate: float | None
    rate_low: float | None
    rate_high: float | None


class Goal(Record):
    """Whether the new trials meet the goal.

    Attributes
    ----------
    name : str or None
        Name of the goal (of several goals the worst), to which these values apply.
    condition : str or None
        The worst condition, to which these values apply.
    status : Literal["met", "missed", "undecided"]
        Verdict on the goal.
    rate : float or None
        Proportion of moves that meet the goal, with one-sided bounds; with worlds of the worst world.
    rate_low : float or None
        Lower bound.
    rate_high : float or None
        Upper bound.
    machines : float or None
        Proportion of machines that meet the goal, with one-sided bounds; with worlds of the worst world; left out where
        the goal is not on machines.
    machines_low : float or None
        Lower bound.
    machines_high : float or None
        Upper bound.
    without_miss : float or None
        Proportion of machines without a miss in as many moves as these have, with one-sided bounds; left out where the
        goal is not on machines.
    without_miss_low : float or None
        Lower bound.
    without_miss_high : float or None
        Upper bound.
    trials_of_one_machine : int or None
        Trials without a miss that show of one machine that it meets the goal; left out where the goal is not on
        machines.
    other_mass : OtherMass or None
        The same values of the load, which the goal of the motor does not limit.
    machines_without_miss : int or None
        Machines all of whose moves meet the goal.
    """

    _records = {"other_mass": OtherMass}

    name: str | None
    condition: str | None
    status: Literal["met", "missed", "undecided"]
    rate: float | None
    rate_low: float | None
    rate_high: float | None
    machines: float | None
    machines_low: float | None
    machines_high: float | None
    without_miss: float | None
    without_miss_low: float | None
    without_miss_high: float | None
    trials_of_one_machine: int | None
    other_mass: OtherMass | None
    machines_without_miss: int | None


class Confirmation(Record):
    """New trials of the chosen point (--confirm).

    Attributes
    ----------
    point : int
        Number of the design point.
    seed : int
        Seed of the new trials.
    trials : int
        New trials.
    zero_count : int
        New trials that succeeded.
    success_rate : float or None
        Their proportion, with bounds of Clopper and Pearson unless trials share machines.
    success_rate_low : float or None
        Lower bound.
    success_rate_high : float or None
        Upper bound.
    one_trial_per_machine : bool
        Whether every new trial has a machine of its own.
    goal : Goal or None
        Whether the new trials meet the goal.
    """

    _records = {"goal": Goal}

    point: int
    seed: int
    trials: int
    zero_count: int
    success_rate: float | None
    success_rate_low: float | None
    success_rate_high: float | None
    one_trial_per_machine: bool
    goal: Goal | None


class SummaryAnswer(Answer):
    """Statistics of a study by design point; units and meanings are those of a rotary axis.

    Attributes
    ----------
    name : str
        Name of the study.
    design : str
        How trials are drawn.
    conservative_bounds : bool
        Whether the design makes bounds wider than needed.
    confidence : float or None
        Of all bounds.
    unfinished : Unfinished or None
        How far the run has come.
    best : Best or None
        The point that the headline is of, and its competitors.
    points : pandas.DataFrame
        The design points.

        - ``point``: number of the design point, for people its label; *: the headline speaks of it
        - ``label``: label of the design point
        - ``axes``: values of the swept parameters; null where one has a distribution
        - ``goal``.* (name, condition, status, rate, rate_low, rate_high, machines, machines_low, machines_high,
          without_miss, without_miss_low, without_miss_high, trials_of_one_machine, other_mass, machines_without_miss):
          whether the point meets the goal, with bounds of this point alone
        - ``goals``: each of the goals, by name
          - ``name``: name of the goal (of several goals the worst), to which these values apply
          - ``condition``: the worst condition, to which these values apply
          - ``status``: verdict on the goal
          - ``rate``: proportion of moves that meet the goal, with one-sided bounds; with worlds of the worst world
          - ``rate_low``: lower bound
          - ``rate_high``: upper bound
          - ``machines``: proportion of machines that meet the goal, with one-sided bounds; with worlds of the worst
            world; left out where the goal is not on machines
          - ``machines_low``: lower bound
          - ``machines_high``: upper bound
          - ``without_miss``: proportion of machines without a miss in as many moves as these have, with one-sided
            bounds; left out where the goal is not on machines
          - ``without_miss_low``: lower bound
          - ``without_miss_high``: upper bound
          - ``trials_of_one_machine``: trials without a miss that show of one machine that it meets the goal; left out
            where the goal is not on machines
          - ``other_mass``.* (of, rate, rate_low, rate_high): the same values of the load, which the goal of the motor
            does not limit
          - ``machines_without_miss``: machines all of whose moves meet the goal
        - ``machines_together``: proportion of machines that meet all goals on machines, as observed; nothing where only
          one claim is on machines
        - ``trials``: trials of the point
        - ``zero_count``: trials whose worst move ended at zero error
        - ``one_count``: trials whose worst move ended within one count
        - ``off_target``: trials whose worst move ended beyond one count without oscillating: neither stable nor shown
          unstable
        - ``oscillating``: trials whose worst move ended beyond one count, oscillating
        - ``nonfinite``: trials with a move that left the finite numbers
        - ``open_loop``: trials with torque levels in place of targets, which are not judged
        - ``stable``: trials all of whose moves arrived and stayed within one count
        - ``arrived``: trials all of whose moves arrived
        - ``broke_away``: trials in which the hook slid during any move
        - ``saturated``: trials in which the DAC clipped during any move
        - ``success_rate``: zero_count as a proportion of trials, NaN of an open-loop study
        - ``success_rate_low``: lower 95 % bound of success_rate: Clopper-Pearson, with machines Korn-Graubard
        - ``success_rate_high``: upper 95 % bound of success_rate: Clopper-Pearson, with machines Korn-Graubard
        - ``success_rate_wilson_low``: lower 95 % Wilson bound of success_rate, with machines for the effective number
          of trials
        - ``success_rate_wilson_high``: upper 95 % Wilson bound of success_rate, with machines for the effective number
          of trials
        - ``stable_rate``: stable as a proportion of trials, NaN of an open-loop study
        - ``stable_rate_low``: lower 95 % bound of stable_rate: Clopper-Pearson, with machines Korn-Graubard
        - ``stable_rate_high``: upper 95 % bound of stable_rate: Clopper-Pearson, with machines Korn-Graubard
        - ``stable_rate_wilson_low``: lower 95 % Wilson bound of stable_rate, with machines for the effective number of
          trials
        - ``stable_rate_wilson_high``: upper 95 % Wilson bound of stable_rate, with machines for the effective number of
          trials
        - ``arrival_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95, p95_low,
          p95_high, max, mean_low, mean_high): statistics of arrival time
        - ``jerk_count``.* (n, mean, sd, median, p95, max, total, mean_low, mean_high): statistics of jerk count
        - ``jerk_interval``.* (n, mean, median): statistics of jerk interval
        - ``jerk_slowing``.* (moves, slowing, quickening, share, tau): statistics of jerk slowing
        - ``jerk_agreement``: jerks in the direction of the holding torque as a proportion of all jerks
        - ``jerk_one_count_share``: jerks of one count as a proportion of all jerks
        - ``final_settling_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95, p95_low,
          p95_high, max, mean_low, mean_high): statistics of final settling time
        - ``overshoot``.* (n, mean, max): statistics of overshoot
        - ``holding_torque``.* (n, mean, min, max): statistics of holding torque
        - ``peak_torque``.* (n, mean, max): statistics of peak torque
        - ``creep``.* (n, mean, min, max): statistics of creep
        - ``reversal_depth_max``: largest number of reversal points on the stack
        - ``final_error``.* (n, mean, median, median_low, median_high, p95, p95_low, p95_high, max): statistics of final
          error
        - ``zero_fraction``.* (n, mean): statistics of zero fraction
        - ``oscillation``.* (n, amplitude_median, period_median): statistics of oscillation
        - ``true_error``.* (n, mean, rms, max): statistics of true error
        - ``travel_time``.* (mean, max): statistics of travel time
        - ``phase_changes``.* (trials, mean, max): statistics of phase changes
        - ``encoder_disagreement``.* (trials, mean, max): statistics of encoder disagreement
        - ``machines``.* (n, success_sd, without_failure, without_failure_low, without_failure_high, worst_5_percent):
          statistics of machines
        - ``true_overshoot``.* (n, mean, p95, max): statistics of true overshoot
        - ``stopped``: trials that were ended early, because a move had diverged
        - ``controller_failed``: trials that the controller ended by giving no finite torque
        - ``rest_error_rms``.* (n, mean, max, mean_low, mean_high): statistics of rest error rms
        - ``rest_error_range``.* (n, mean, max, mean_low, mean_high): statistics of rest error range
        - ``rest_motion_rms``.* (n, mean, max, mean_low, mean_high): statistics of rest motion rms
        - ``rest_motion_range``.* (n, mean, max, mean_low, mean_high): statistics of rest motion range
        - ``rest_torque_power``.* (n, mean, max, mean_low, mean_high): statistics of rest torque power
        - ``rest_torque_noise``.* (n, mean, max, mean_low, mean_high): statistics of rest torque noise
        - ``step_motion``.* (n, mean, max, mean_low, mean_high): statistics of step motion
        - ``step_made``.* (rate, rate_low, rate_high): statistics of step made
        - ``following_error_rms``.* (n, mean, max, mean_low, mean_high): statistics of following error rms
        - ``following_error_peak``.* (n, mean, max, mean_low, mean_high): statistics of following error peak
        - ``reversal_spike``.* (n, mean, max, mean_low, mean_high): statistics of reversal spike
        - ``load_true_error``.* (n, mean, rms, max): statistics of load true error
        - ``load_true_overshoot``.* (n, mean, p95, max): statistics of load true overshoot
        - ``motor_true_error``.* (n, mean, rms, max): statistics of motor true error
        - ``motor_true_overshoot``.* (n, mean, p95, max): statistics of motor true overshoot
        - ``bands``: statistics by error band
          - ``band``: largest error of the band, count
          - ``entry_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95, p95_low,
            p95_high, max): statistics of entry time
          - ``settling_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95, p95_low,
            p95_high, max, mean_low, mean_high): statistics of settling time
          - ``exits``.* (n, mean, sd, p95, max, total, mean_low, mean_high): statistics of exits
        - ``tolerances``: statistics by tolerance of the position error
          - ``tolerance``: largest position error within the tolerance, rad
          - ``settling_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95, p95_low,
            p95_high, max, mean_low, mean_high): statistics of settling time
          - ``load_settling_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95, p95_low,
            p95_high, max, mean_low, mean_high): statistics of load settling time
          - ``motor_settling_time``.* (n, moves, mean, min, p05, p25, median, median_low, median_high, p75, p95,
            p95_low, p95_high, max, mean_low, mean_high): statistics of motor settling time
        - ``moves``: counts of trials by move
          - ``zero_count``: trials with this outcome of the move
          - ``one_count``: trials with this outcome of the move
          - ``oscillating``: trials with this outcome of the move
          - ``nonfinite``: trials with this outcome of the move
          - ``open_loop``: trials with this outcome of the move
          - ``off_target``: trials with this outcome of the move
          - ``stable``: trials whose move has this quality
          - ``arrived``: trials whose move has this quality
          - ``broke_away``: trials whose move has this quality
          - ``saturated``: trials whose move has this quality
          - ``stopped``: trials whose move has this quality
          - ``controller_failed``: trials whose move has this quality
        - ``prediction``.* (trials, stable, unstable, stable_share, unstable_share, verdict): by the paper's criteria
        - ``observed``: what was observed on the real machine
        - ``undecided``.* (moves, off_target, still_falling, falling_with_ripple, about_to_arrive, hold_at_least): moves
          that are neither stable nor shown unstable
        - ``observed_counts``.* (successes, of, simulated_successes, simulated_of, p_value, lowest_p_value, verdict,
          statement): trials on the real machine against those simulated
        - ``repeatability``.* (trials, evaluated, zero_repeatability, zero_repeatability_rate,
          zero_repeatability_rate_low, zero_repeatability_rate_high, true, encoder, load_true, motor_true): values of
          ISO 230-2
        - ``stopping``.* (success_rate_low, success_rate_high, confidence, halfwidth, halfwidth_asked,
          halfwidth_confidence, reached, of_machines): what the rule that ended the study asked for, and what was
          reached
        - ``worlds``.* (n, success, success_rates, goal_rates, goal_status, met, missed, undecided, bad_worlds, rule):
          the worlds at the point
        - ``claims``: each goal under each condition at the point
          - ``goal``: name of the goal
          - ``condition``: condition under which every machine runs
          - ``moves``: moves that the goal asks, of all trials
          - ``met``: of them, moves that meet the goal
          - ``rate``: proportion of moves (under a condition of what the question is about, without a goal of trials),
            with one-sided bounds; of the worst goal, condition and world
          - ``rate_low``: lower bound
          - ``rate_high``: upper bound
          - ``machines``: proportion of machines that meet the goal, at an age under every condition, with one-sided
            bounds that allow for the few moves in which each was seen
          - ``machines_low``: lower bound
          - ``machines_high``: upper bound
          - ``settling_time_p95``: 95 % quantile of the settling time, of the goal and condition that the rate is of;
            none where it is not within the hold, s
          - ``within``: time from the start of a move that the goal allows, the longest of its moves, s
          - ``status``: verdict on the goal
        - ``conditions``: the point under each condition
          - ``condition``: condition under which every machine runs
          - ``trials``: trials under the condition, or at the age
          - ``success``: trials all of whose moves ended at zero error
          - ``goal_met``: trials all of whose moves meet the goal
          - ``goal``: name of the goal that rate and settling time are of, the worst of several
          - ``rate``: proportion of moves (under a condition of what the question is about, without a goal of trials),
            with one-sided bounds; of the worst goal, condition and world
          - ``rate_low``: lower bound
          - ``rate_high``: upper bound
          - ``status``: verdict on the goal
        - ``ages``: the point at each age
          - ``age``: age of the machines, in the unit of the manifest, cycles
          - ``trials``: trials under the condition, or at the age
          - ``success``: trials all of whose moves ended at zero error
          - ``goal_met``: trials all of whose moves meet the goal
          - ``worst_condition``: the worst of several conditions, which rate and settling time are under
          - ``goal``: name of the goal that rate and settling time are of, the worst of several
          - ``rate``: proportion of moves (under a condition of what the question is about, without a goal of trials),
            with one-sided bounds; of the worst goal, condition and world
          - ``rate_low``: lower bound
          - ``rate_high``: upper bound
          - ``machines``: proportion of machines that meet the goal, at an age under every condition, with one-sided
            bounds that allow for the few moves in which each was seen
          - ``machines_low``: lower bound
          - ``machines_high``: upper bound
          - ``living``: proportion of the machines that meet it at every age up to this one, with one-sided bounds of
            Clopper and Pearson, which take the verdict on each machine as it was seen
          - ``living_low``: lower bound
          - ``living_high``: upper bound
          - ``settling_time_p95``: 95 % quantile of the settling time, of the goal and condition that the rate is of;
            none where it is not within the hold, s
          - ``status``: verdict on the goal
        - ``assurance``.* (success_at_least, failure_at_most, rule_of_three, arrival_time, statement, machines): what
          the trials show of all axes that the manifest describes
        - ``levels``: the torque levels
          - ``level``: number of the torque level
          - ``n``: trials whose motion was not lost, of which the values of the level are
          - ``nonfinite``: trials whose motion was lost in the level or before
          - ``torque``: mean torque at the end of the level, N m
          - ``position``.* (mean, low, high, sd, min, max): statistics of position
          - ``creep``.* (mean, low, high, sd, min, max): statistics of creep
          - ``broke_away``: trials in which the hook slid during the level
          - ``reversal_depth_max``: largest number of reversal points on the stack during the level

    confirmation : Confirmation or None
        New trials of the chosen point (--confirm).
    """

    _records = {"unfinished": Unfinished, "best": Best, "confirmation": Confirmation}

    name: str
    design: str
    conservative_bounds: bool
    confidence: float | None
    unfinished: Unfinished | None
    best: Best | None
    points: pandas.DataFrame
    confirmation: Confirmation | None


class VerifyAnswer(Answer):
    """Whether results files hold what their manifests say.

    Attributes
    ----------
    ok : bool
        Whether all checks hold.
    files : pandas.DataFrame
        The files, and the folders of shards.

        - ``path``: the file or folder
        - ``ok``: whether all its checks hold
        - ``checks``: its checks
          - ``check``: name of the check
          - ``ok``: whether it has found no problem
          - ``skipped``: whether it was left out
          - ``detail``: what was checked, or why it was left out
          - ``problems``: what does not hold

    """

    ok: bool
    files: pandas.DataFrame


class ExperimentAnswer(Answer):
    """The record from which 'zerocount identify' estimates the friction.

    Attributes
    ----------
    name : str
        Name of the study.
    axis : Literal["rotary", "linear"]
        Kind of axis.
    sample_time : float or None
        Time between samples, s.
    samples : int
        Samples of the record.
    max_torque : float or None
        Largest torque or force, N m or N.
    least_breakaway : float or None
        Least breakaway of the machines, N m or N.
    travel : float or None
        Largest distance from the start on any machine, rad or m.
    machines : int
        Machines on which it is safe.
    protocols : int
        Protocols that were tried.
    converged : bool
        Whether no change of the protocol was better.
    residuals_passed : bool
        Whether identify explains the simulated record.
    segments : pandas.DataFrame
        Parts of the record.

        - ``to``: torque or force to which it leads linearly, N m or N
        - ``samples``: its samples

    parameters : pandas.DataFrame
        What to expect of each parameter.

        - ``key``: dotted path in a manifest
        - ``guess``: value of the median machine, in the unit
        - ``unit``: unit of the parameter
        - ``status``: whether the record determines it
        - ``low``: lower end of the 95 % interval to expect
        - ``high``: its upper end
        - ``told``: machines on which the record determines it
        - ``narrowest``: least half-width of the interval over the machines, relative
        - ``widest``: largest half-width of the interval over the machines, relative
        - ``reason``: why the record does not determine it; empty: it does

    identify : str
        The command that identifies the record.
    """

    name: str
    axis: Literal["rotary", "linear"]
    sample_time: float | None
    samples: int
    max_torque: float | None
    least_breakaway: float | None
    travel: float | None
    machines: int
    protocols: int
    converged: bool
    residuals_passed: bool
    segments: pandas.DataFrame
    parameters: pandas.DataFrame
    identify: str


class Errors(Record):
    """Joint errors of the estimates.

    Attributes
    ----------
    parameters : list[str]
        Names, in the order of the matrices.
    covariance : list[list[float or None]]
        Covariance of the errors of the logarithms; for n and the time offset: of the errors themselves.
    correlation : list[list[float or None]]
        Correlation of the errors whose covariance is given.
    """

    parameters: list[str]
    covariance: list[list[float | None]]
    correlation: list[list[float | None]]


class Residuals(Record):
    """Checks of the residuals.

    Attributes
    ----------
    observations : int
        Residuals.
    spread : float or None
        Root mean square of the residuals over their standard deviations.
    expected_spread : float or None
        Its mean over the replicates.
    spread_chance : float or None
        Proportion of replicates with at least this spread.
    runs : float or None
        Runs of one sign.
    expected_runs : float or None
        Their mean over the replicates.
    runs_chance : float or None
        Proportion of replicates at least as far off.
    correlation_length : float or None
        Correlation length of the residuals, in residuals.
    expected_correlation_length : float or None
        Its mean over the replicates.
    passed : bool
        Whether encoder and noise explain the residuals.
    reason : str or None
        What they do not explain; null: nothing.
    widening : float or None
        Factor that widened the intervals.
    """

    observations: int
    spread: float | None
    expected_spread: float | None
    spread_chance: float | None
    runs: float | None
    expected_runs: float | None
    runs_chance: float | None
    correlation_length: float | None
    expected_correlation_length: float | None
    passed: bool
    reason: str | None
    widening: float | None


class ResidualLine(Record):
    """Spectral line of the residuals that a second mass may make.

    Attributes
    ----------
    record : str
        Record with the line.
    frequency : float or None
        Its frequency, Hz.
    """

    record: str
    frequency: float | None


class IdentifyAnswer(Answer):
    """Friction, damping and inertia from material tests.

    Attributes
    ----------
    axis : Literal["rotary", "linear"]
        Kind of axis.
    parameters : pandas.DataFrame
        The parameters.

        - ``name``: name of the parameter
        - ``key``: dotted path in a manifest; null: it has none
        - ``unit``: unit of its numbers
        - ``status``: whether the records determine it
        - ``value``: estimate, in the unit
        - ``standard_error``: its standard error, in the unit
        - ``low``: lower end of its 95 % interval, in the unit
        - ``high``: upper end of its 95 % interval, in the unit
        - ``reason``: why it is not identifiable, or kept
        - ``distribution``: distribution in a manifest whose central 95 % are the interval

    sample_time : float or None
        Time between samples of the first record, s.
    correlations : pandas.DataFrame
        Pairs of parameters whose errors correlate by 0.9 and more.

        - ``one``: a parameter
        - ``other``: the other one
        - ``value``: correlation of their errors

    errors : Errors
        Joint errors of the estimates.
    records : pandas.DataFrame
        What each record has of the tests.

        - ``name``: file, and part of it
        - ``samples``: samples of the record
        - ``duration``: its duration, s
        - ``counted``: whether it is read in counts
        - ``unit``: size of a unit of the readings, rad or m
        - ``branches``: slow branches of the torque
        - ``reversals``: reversals of the torque
        - ``holds``: stretches of constant torque
        - ``ring_downs``: oscillations that die out after a step
        - ``misfit``: root mean square of the residuals, in units of the readings
        - ``noise``: standard deviation of the readings, in their unit
        - ``excluded``: samples masked by --exclude
        - ``note``: what was cut out of it

    residuals : Residuals
        Checks of the residuals.
    residual_line : ResidualLine or None
        Spectral line of the residuals that a second mass may make.
    search_ended : bool
        Whether the search ended because of --effort.
    manifest : str
        The parameters as a fragment of a manifest.
    """

    _records = {"errors": Errors, "residuals": Residuals, "residual_line": ResidualLine}

    axis: Literal["rotary", "linear"]
    parameters: pandas.DataFrame
    sample_time: float | None
    correlations: pandas.DataFrame
    errors: Errors
    records: pandas.DataFrame
    residuals: Residuals
    residual_line: ResidualLine | None
    search_ended: bool
    manifest: str


class IdentifyLawsAnswer(Answer):
    """Friction laws compared on the same records.

    Attributes
    ----------
    kind : str
        Always laws.
    axis : Literal["rotary", "linear"]
        Kind of axis.
    laws : pandas.DataFrame
        The laws, the best one first.

        - ``law``: word of the friction law
        - ``fitted``: fitted numbers, with the time offset
        - ``misfit``: root mean square of the residuals, rad or m
        - ``misfit_over_travel``: the same over the travel of the records
        - ``bic_above_least``: Schwarz's criterion less that of the best law, the first one; negative for one that does
          not explain the records
        - ``explained``: whether they explain the residuals
        - ``spread``: root mean square of the residuals over their standard deviations
        - ``expected_spread``: its mean over replicates
        - ``widening``: factor that widened the intervals
        - ``converged``: whether the fit converged
        - ``parameters``: its parameters
          - ``name``: name of the parameter
          - ``key``: dotted path in a manifest; null: it has none
          - ``unit``: unit of its numbers
          - ``status``: whether the records determine it
          - ``value``: estimate, in the unit
          - ``standard_error``: its standard error, in the unit
          - ``low``: lower end of its 95 % interval, in the unit
          - ``high``: upper end of its 95 % interval, in the unit
          - ``reason``: why it is not identifiable, or kept
          - ``distribution``: distribution in a manifest whose central 95 % are the interval
        - ``manifest``: the law as a fragment of a manifest

    left_out : pandas.DataFrame
        Laws that could not be fitted.

        - ``law``: word of the friction law
        - ``reason``: why it could not be fitted

    readings : int
        Readings of all records.
    effective_readings : float or None
        Those that count as independent in BIC.
    sample_time : float or None
        Time between samples, s.
    records : pandas.DataFrame
        The records.

        - ``name``: file, and part of it
        - ``samples``: samples of the record
        - ``excluded``: samples masked by --exclude
        - ``note``: what was cut out of it

    manifest : str
        The parameters as a fragment of a manifest.
    """

    kind: str
    axis: Literal["rotary", "linear"]
    laws: pandas.DataFrame
    left_out: pandas.DataFrame
    readings: int
    effective_readings: float | None
    sample_time: float | None
    records: pandas.DataFrame
    manifest: str


class Correlation(Record):
    """Correlation of the errors of the fitted parameters.

    Attributes
    ----------
    parameters : list[str]
        Names, in the order of the matrix.
    matrix : list[list[float or None]]
        Correlations.
    """

    parameters: list[str]
    matrix: list[list[float | None]]


class SecondMass(Record):
    """A second mass that the records show; null: none is shown, or another fault comes first.

    Attributes
    ----------
    explained : float or None
        Part of the squares of the residuals that it explains.
    frequency : float or None
        Frequency of the masses against each other, Hz; 0: not well known.
    """

    explained: float | None
    frequency: float | None


class Reversal(Record):
    """Friction after reversals; null: none without a standstill.

    Attributes
    ----------
    reversals : int
        Reversals without a standstill.
    swing : float or None
        Sum of the levels of both directions near a reversal, median, N m or N.
    travel : float or None
        Travel after a reversal in which nine tenths of the change of the friction take place, median, rad or m.
    min_travel : float or None
        Smallest of them, rad or m.
    max_travel : float or None
        Largest of them, rad or m.
    samples : int
        Samples in that travel, median; below 6 the travel is an upper bound.
    stiffness : float or None
        0.9 times swing, divided by travel, N m/rad or N/m.
    """

    reversals: int
    swing: float | None
    travel: float | None
    min_travel: float | None
    max_travel: float | None
    samples: int
    stiffness: float | None


class IdentifySlidingAnswer(Answer):
    """Inertia and friction of an axis from its sliding motion.

    Attributes
    ----------
    kind : str
        Always sliding.
    axis : Literal["rotary", "linear"]
        Kind of axis.
    parameters : pandas.DataFrame
        The parameters.

        - ``name``: name of the parameter
        - ``key``: dotted path in a manifest; null: it has none
        - ``unit``: unit of its numbers
        - ``status``: whether the records determine it
        - ``value``: estimate, in the unit
        - ``standard_error``: its standard error, in the unit
        - ``low``: lower end of its 95 % interval, in the unit
        - ``high``: upper end of its 95 % interval, in the unit
        - ``reason``: why it is not identifiable, or kept
        - ``distribution``: distribution in a manifest whose central 95 % are the interval

    correlation : Correlation
        Correlation of the errors of the fitted parameters.
    records : pandas.DataFrame
        What was used of each record.

        - ``name``: file, and part of it
        - ``samples``: samples of the record
        - ``duration``: its duration, s
        - ``resolution``: step of the readings, rad or m
        - ``presliding_travel``: travel after a standstill or a reversal in which the friction is below its level of
          sliding, which was left out, rad or m
        - ``strokes``: strokes of the record
        - ``windows``: windows of the fit
        - ``used``: samples in the windows
        - ``min_velocity``: least speed, rad/s or m/s
        - ``max_velocity``: largest speed, rad/s or m/s

    misfit : float or None
        Root mean square of the residuals, in steps of the readings.
    unexplained_torque : float or None
        Its root mean square over the windows, N m or N.
    torque : float or None
        Root mean square of the torque in the strokes, N m or N.
    second_mass : SecondMass or None
        A second mass that the records show; null: none is shown, or another fault comes first.
    missing : pandas.DataFrame
        Torques that the residuals show; empty: none.

        - ``cause``: what the torque goes with
        - ``torque``: the torque, in words
        - ``explained``: proportion of the squares of the residuals that it explains
        - ``visibility``: ratio of its coefficient to the standard error, over the ratio that chance exceeds once in
          1000 records

    reversal : Reversal or None
        Friction after reversals; null: none without a standstill.
    simulation : pandas.DataFrame
        Motion of the identified axis beside the readings.

        - ``name``: file, and part of it
        - ``start``: time at which the simulation begins with the measured state, s
        - ``duration``: simulated time without a restart, s
        - ``rms``: root mean square of simulated less read positions, rad or m
        - ``max``: largest difference, rad or m
        - ``stroke``: largest less smallest reading, rad or m
        - ``proportion``: rms over the stroke

    unexplained : pandas.DataFrame
        cross-validated over strokes; empty with a single stroke.

        - ``with``: what the unexplained torque may repeat with
        - ``predicted``: part of its variance that the means over other strokes predict; 0 or less: it does not repeat
        - ``low``: smallest mean over a tenth of the range, N m or N
        - ``high``: largest mean over a tenth of the range, N m or N

    manifest : str
        The parameters as a fragment of a manifest.
    """

    _records = {"correlation": Correlation, "second_mass": SecondMass, "reversal": Reversal}

    kind: str
    axis: Literal["rotary", "linear"]
    parameters: pandas.DataFrame
    correlation: Correlation
    records: pandas.DataFrame
    misfit: float | None
    unexplained_torque: float | None
    torque: float | None
    second_mass: SecondMass | None
    missing: pandas.DataFrame
    reversal: Reversal | None
    simulation: pandas.DataFrame
    unexplained: pandas.DataFrame
    manifest: str


class Needed(Record):
    """Study that would decide the goal.

    Attributes
    ----------
    machine_count : int
        Number of machines; 0 without machines.
    trials : int
        Trials of a design point.
    """

    machine_count: int
    trials: int


class Success(Record):
    """Rates of success by world.

    Attributes
    ----------
    worst : float or None
        Rate of the worst world, with one-sided bounds.
    worst_low : float or None
        Lower bound.
    worst_high : float or None
        Upper bound.
    median : float or None
        Median of the rates.
    best : float or None
        Rate of the best world.
    worst_world : int
        Index of the worst world.
    best_world : int
        Index of the best world.
    """

    worst: float | None
    worst_low: float | None
    worst_high: float | None
    median: float | None
    best: float | None
    worst_world: int
    best_world: int


class Rule(Record):
    """What the bad worlds have in common.

    Attributes
    ----------
    text : str
        The rule in words.
    conditions : pandas.DataFrame
        Conditions of the rule.

        - ``parameter``: dotted path, or name of a derived quantity
        - ``relation``: sign between parameter and value
        - ``value``: threshold, in the unit of the parameter

    same : pandas.DataFrame
        Conditions each of which alone names the same worlds.

        - ``parameter``: dotted path, or name of a derived quantity
        - ``relation``: sign between parameter and value
        - ``value``: threshold, in the unit of the parameter

    joined_by : Literal["and", "or"]
        How the conditions are joined.
    bad_named : int
        Bad worlds that the rule names.
    others_named : int
        Other worlds that it names.
    error_rate : float or None
        Proportion of worlds named wrongly.
    p_value : float or None
        Probability of such a rule by chance.
    """

    text: str
    conditions: pandas.DataFrame
    same: pandas.DataFrame
    joined_by: Literal["and", "or"]
    bad_named: int
    others_named: int
    error_rate: float | None
    p_value: float | None


class JudgeWorlds(Record):
    """The worlds at the point.

    Attributes
    ----------
    n : int
        Number of worlds.
    success : Success
        Rates of success by world.
    success_rates : list[float or None]
        Rate of success of each world.
    goal_rates : list[float or None] or None
        Proportion of moves of each world that meet the goal.
    goal_status : list[Literal["met", "missed", "undecided"]] or None
        Verdict of each world.
    met : int or None
        Worlds in which the goal is met.
    missed : int or None
        Worlds in which the goal is missed.
    undecided : int or None
        Worlds in which the goal is undecided.
    bad_worlds : list[int]
        Indices of the worlds that fall short.
    rule : Rule or None
        What the bad worlds have in common.
    """

    _records = {"success": Success, "rule": Rule}

    n: int
    success: Success
    success_rates: list[float | None]
    goal_rates: list[float | None] | None
    goal_status: list[Literal["met", "missed", "undecided"]] | None
    met: int | None
    missed: int | None
    undecided: int | None
    bad_worlds: list[int]
    rule: Rule | None


class JudgeAnswer(Answer):
    """Whether a study meets its goal.

    Attributes
    ----------
    point : int
        Number of the design point.
    label : str
        Label of the design point.
    goal : str
        The goal in words.
    worst_goal : str or None
        Name of the goal that the numbers are of, the worst of several.
    worst_condition : str or None
        The condition that they are under, the worst of several.
    status : Literal["met", "missed", "undecided"]
        Verdict on the goal.
    rate : float or None
        Proportion of moves that meet the goal, with one-sided bounds.
    rate_low : float or None
        Lower bound.
    rate_high : float or None
        Upper bound.
    machines_low : float or None
        Lower bound of the proportion of machines that meet the goal, if it is about machines.
    machines_high : float or None
        Its upper bound.
    other_mass : OtherMass or None
        The same values of the load, which the goal of the motor does not limit.
    missed_saturated : float or None
        Proportion of the moves that miss the goal in which the converter clipped; null: the goal is met, or the file
        does not keep every trial.
    chosen_from : int
        Design points that the point is the best of; 1 if it was named.
    needed : Needed or None
        Study that would decide the goal.
    worlds : JudgeWorlds or None
        The worlds at the point.
    claims : pandas.DataFrame
        Each goal under each condition.

        - ``goal``: name of the goal
        - ``condition``: condition under which every machine runs
        - ``moves``: moves that the goal asks, of all trials
        - ``met``: of them, moves that meet the goal
        - ``rate``: proportion of moves (under a condition of what the question is about, without a goal of trials),
          with one-sided bounds; of the worst goal, condition and world
        - ``rate_low``: lower bound
        - ``rate_high``: upper bound
        - ``machines``: proportion of machines that meet the goal, at an age under every condition, with one-sided
          bounds that allow for the few moves in which each was seen
        - ``machines_low``: lower bound
        - ``machines_high``: upper bound
        - ``settling_time_p95``: 95 % quantile of the settling time, of the goal and condition that the rate is of; none
          where it is not within the hold, s
        - ``within``: time from the start of a move that the goal allows, the longest of its moves, s
        - ``status``: verdict on the goal

    met_until : float or None
        Last age up to and including which the goal is met; null if not at the first.
    missed_from : float or None
        First age at which the goal is shown to be missed.
    ages : pandas.DataFrame
        The point at each age.

        - ``age``: age of the machines, in the unit of the manifest
        - ``trials``: trials under the condition, or at the age
        - ``success``: trials all of whose moves ended at zero error
        - ``goal_met``: trials all of whose moves meet the goal
        - ``worst_condition``: the worst of several conditions, which rate and settling time are under
        - ``goal``: name of the goal that rate and settling time are of, the worst of several
        - ``rate``: proportion of moves (under a condition of what the question is about, without a goal of trials),
          with one-sided bounds; of the worst goal, condition and world
        - ``rate_low``: lower bound
        - ``rate_high``: upper bound
        - ``machines``: proportion of machines that meet the goal, at an age under every condition, with one-sided
          bounds that allow for the few moves in which each was seen
        - ``machines_low``: lower bound
        - ``machines_high``: upper bound
        - ``living``: proportion of the machines that meet it at every age up to this one, with one-sided bounds of
          Clopper and Pearson, which take the verdict on each machine as it was seen
        - ``living_low``: lower bound
        - ``living_high``: upper bound
        - ``settling_time_p95``: 95 % quantile of the settling time, of the goal and condition that the rate is of; none
          where it is not within the hold, s
        - ``status``: verdict on the goal

    """

    _records = {"other_mass": OtherMass, "needed": Needed, "worlds": JudgeWorlds}

    point: int
    label: str
    goal: str
    worst_goal: str | None
    worst_condition: str | None
    status: Literal["met", "missed", "undecided"]
    rate: float | None
    rate_low: float | None
    rate_high: float | None
    machines_low: float | None
    machines_high: float | None
    other_mass: OtherMass | None
    missed_saturated: float | None
    chosen_from: int
    needed: Needed | None
    worlds: JudgeWorlds | None
    claims: pandas.DataFrame
    met_until: float | None
    missed_from: float | None
    ages: pandas.DataFrame


class LearnAnswer(Answer):
    """Which unknown to measure next.

    Attributes
    ----------
    point : int
        Number of the design point.
    label : str
        Label of the design point.
    status : Literal["met", "missed", "undecided"] or None
        Verdict on the goal; null without one.
    worlds : int
        Number of worlds.
    bad : int
        Worlds that fall short.
    undecided : int
        Worlds that are undecided.
    needed : Needed or None
        Study that would decide the goal.
    next : Literal["nothing", "change_axis", "more_trials", "measure", "no_single_measurement"]
        What to do next.
    measure : str or None
        The unknown to measure; null: none.
    precision : float or None
        Relative error of the measurement.
    unknowns : pandas.DataFrame
        What a measurement of each unknown decides.

        - ``parameter``: dotted path of the unknown, or name of a derived quantity
        - ``unit``: unit of the unknown
        - ``derived``: what the derived quantity is
        - ``decided``: worlds that the measurement decides rightly
        - ``decided_good``: worlds that meet the goal and are found to
        - ``decided_bad``: worlds that fall short and are found to
        - ``rejected_good``: worlds that meet the goal and are taken to fall short
        - ``missed_bad``: worlds that fall short and are taken to meet the goal
        - ``misjudged``: worlds that are unlike all that remain possible: both of these
        - ``open``: worlds that the measurement does not decide
        - ``better``: whether it does better than to call all worlds good, or all bad, unmeasured
        - ``p_value``: probability of as many decided if the unknowns did not matter
        - ``record``: record of 'zerocount identify' that shows the unknown; null: none

    """

    _records = {"needed": Needed}

    point: int
    label: str
    status: Literal["met", "missed", "undecided"] | None
    worlds: int
    bad: int
    undecided: int
    needed: Needed | None
    next: Literal["nothing", "change_axis", "more_trials", "measure", "no_single_measurement"]
    measure: str | None
    precision: float | None
    unknowns: pandas.DataFrame


class Margins(Record):
    """Its smallest margins.

    Attributes
    ----------
    gain : float or None
        Gain margin; unknown where no loop has a limit, dB.
    phase : float or None
        Phase margin; unknown where no loop has a limit, degrees.
    delay : float or None
        Samples of delay until a loop is unstable; 10 means 10 or more, samples.
    sensitivity : float or None
        Largest |S|, S = 1/(1 + L).
    crossover : float or None
        Highest frequency at which |L| = 1; 0 without one, Hz.
    stable : bool
        Whether no loop is unstable.
    machines : int
        Machines that were examined.
    """

    gain: float | None
    phase: float | None
    delay: float | None
    sensitivity: float | None
    crossover: float | None
    stable: bool
    machines: int


class Nearest(Record):
    """The point that comes nearest to the margins, where none keeps them.

    Attributes
    ----------
    gains : dict[str, float or None]
        Its values, by parameter.
    margins : Margins
        Its smallest margins.
    lacking : dict[str, float or None]
        By how much margins are too small, or the sensitivity too large: dB, degrees, samples, 1.
    """

    _records = {"margins": Margins}

    gains: dict[str, float | None]
    margins: Margins
    lacking: dict[str, float | None]


class TuneProofWorlds(Record):
    """Verdicts by world.

    Attributes
    ----------
    met : int
        Worlds in which the goal is met.
    missed : int
        Worlds in which the goal is missed.
    undecided : int
        Worlds in which the goal is undecided.
    """

    met: int
    missed: int
    undecided: int


class Proof(Record):
    """Trials of the tuned values on machines that the search never saw.

    Attributes
    ----------
    goal : str or None
        Its goal, of several.
    condition : str or None
        Its condition, with conditions.
    status : Literal["met", "missed", "undecided"]
        Verdict on the goal by the trials of the proof, which is that of judge.
    rate : float or None
        Proportion of moves that meet the goal, with one-sided bounds.
    rate_low : float or None
        Lower bound.
    rate_high : float or None
        Upper bound.
    machines_low : float or None
        Lower bound of the proportion of machines that meet the goal, if it is about machines.
    machine_count : int
        Number of machines; 0 without machines.
    trials : int
        Trials.
    seed : int
        Seed of the proof.
    attempts : int
        Candidates or sizes that were proven.
    criterion : float or None
        Quantity that is minimised; unknown for never.
    worlds : TuneProofWorlds or None
        Verdicts by world.
    """

    _records = {"worlds": TuneProofWorlds}

    goal: str | None
    condition: str | None
    status: Literal["met", "missed", "undecided"]
    rate: float | None
    rate_low: float | None
    rate_high: float | None
    machines_low: float | None
    machine_count: int
    trials: int
    seed: int
    attempts: int
    criterion: float | None
    worlds: TuneProofWorlds | None


class Worst(Record):
    """The worst machine of the proof.

    Attributes
    ----------
    goal : str or None
        Its goal, of several.
    condition : str or None
        Its condition, with conditions.
    machine : int
        Number of the machine in the study, or of its trial where no trials share a machine.
    trial : int
        Its worst trial.
    met : float or None
        Proportion of its moves that meet the goal.
    inputs : dict[str, float or None]
        What it has drawn, by parameter.
    """

    goal: str | None
    condition: str | None
    machine: int
    trial: int
    met: float | None
    inputs: dict[str, float | None]


class GainMarginLoop(Record):
    """The loop that has the worst gain margin.

    Attributes
    ----------
    loop : str
        The loop in words.
    stiffness : float or None
        Of the contact before it slides, N m/rad (N/m on a linear axis); unknown while sliding.
    machine : int or None
        Number of the machine; unknown where the stiffness says all of it.
    condition : str or None
        The condition under which it runs, in a study with conditions.
    """

    loop: str
    stiffness: float | None
    machine: int | None
    condition: str | None


class PhaseMarginLoop(Record):
    """The loop that has the worst phase margin.

    Attributes
    ----------
    loop : str
        The loop in words.
    stiffness : float or None
        Of the contact before it slides, N m/rad (N/m on a linear axis); unknown while sliding.
    machine : int or None
        Number of the machine; unknown where the stiffness says all of it.
    condition : str or None
        The condition under which it runs, in a study with conditions.
    """

    loop: str
    stiffness: float | None
    machine: int | None
    condition: str | None


class DelayMarginLoop(Record):
    """The loop that has the worst delay margin.

    Attributes
    ----------
    loop : str
        The loop in words.
    stiffness : float or None
        Of the contact before it slides, N m/rad (N/m on a linear axis); unknown while sliding.
    machine : int or None
        Number of the machine; unknown where the stiffness says all of it.
    condition : str or None
        The condition under which it runs, in a study with conditions.
    """

    loop: str
    stiffness: float | None
    machine: int | None
    condition: str | None


class SensitivityLoop(Record):
    """The loop that has the worst sensitivity.

    Attributes
    ----------
    loop : str
        The loop in words.
    stiffness : float or None
        Of the contact before it slides, N m/rad (N/m on a linear axis); unknown while sliding.
    machine : int or None
        Number of the machine; unknown where the stiffness says all of it.
    condition : str or None
        The condition under which it runs, in a study with conditions.
    """

    loop: str
    stiffness: float | None
    machine: int | None
    condition: str | None


class Searched(Record):
    """Size of the search.

    Attributes
    ----------
    points : int
        Points that were simulated.
    telling_points : int
        Points at which some moves meet the worst goal, more than 1 %, and too few; where hardly any point is one, the
        goal is not shown to be out of reach.
    trials : int
        Trials of the search, and of those for other controls.
    seconds : float or None
        Time, s.
    converged : bool
        Whether the last generation improved no more.
    """

    points: int
    telling_points: int
    trials: int
    seconds: float | None
    converged: bool


class TuneAnswer(Answer):
    """Values of the free parameters with which the axis meets its goal.

    Attributes
    ----------
    goal : str
        The goal in words.
    status : Literal["met", "unreachable", "undecided"]
        Whether the goal is met; unreachable: not in the ranges.
    gains : dict[str, float or None]
        Tuned values by parameter; none where no values keep the margins.
    refusals : pandas.DataFrame
        What a drive engineer would refuse of the tuned values, although they may meet the goal.

        - ``finding``: what an engineer would refuse
        - ``text``: the finding in a sentence
        - ``value``: proportion of the step, of the moves, of the converter's largest torque; degrees
        - ``passes``: the value that passes
        - ``remedy``: what excludes it, as it stands in a manifest

    nearest : Nearest or None
        The point that comes nearest to the margins, where none keeps them.
    claims : pandas.DataFrame
        Each goal under each condition, by the proof; the bounds allow for its attempts.

        - ``goal``: name of the goal
        - ``condition``: condition under which every machine runs
        - ``moves``: moves that the goal asks, of all trials
        - ``met``: of them, moves that meet the goal
        - ``rate``: proportion of moves (under a condition of what the question is about, without a goal of trials),
          with one-sided bounds; of the worst goal, condition and world
        - ``rate_low``: lower bound
        - ``rate_high``: upper bound
        - ``machines``: proportion of machines that meet the goal, at an age under every condition, with one-sided
          bounds that allow for the few moves in which each was seen
        - ``machines_low``: lower bound
        - ``machines_high``: upper bound
        - ``settling_time_p95``: 95 % quantile of the settling time, of the goal and condition that the rate is of; none
          where it is not within the hold, s
        - ``within``: time from the start of a move that the goal allows, the longest of its moves, s
        - ``status``: verdict on the goal

    obstacles : list[str]
        What theory says of a goal that is not met.
    proof : Proof or None
        Trials of the tuned values on machines that the search never saw.
    needed : Needed or None
        Study that would decide the goal.
    at_edges : list[str]
        Free parameters at an end of their range.
    worst : Worst or None
        The worst machine of the proof.
    behaviour : pandas.DataFrame
        What the moves of the proof do, by goal and condition; the torque at rest is of machines of the search where the
        study does not measure it.

        - ``goal``: name of the goal that asks the moves
        - ``condition``: the condition under which the machines run
        - ``moves``: moves of these trials
        - ``overshoot_p95``: excursion beyond the target, which 95 % of the moves do not exceed, count
        - ``overshoot_max``: largest excursion beyond the target, count
        - ``overshoot_length_p95``: excursion beyond the target, rad (m on a linear axis), which 95 % of the moves do
          not exceed
        - ``overshoot_length_max``: largest excursion beyond the target, rad (m on a linear axis)
        - ``overshoot_of_step_p95``: excursion beyond the target as a proportion of the move's step, which 95 % of the
          moves do not exceed
        - ``overshoot_of_step_max``: largest excursion beyond the target as a proportion of the move's step
        - ``peak_torque_p95``: absolute torque decided, N m (N on a linear axis), which 95 % of the moves do not exceed
        - ``peak_torque_max``: largest absolute torque decided, N m (N on a linear axis)
        - ``peak_of_range_p95``: absolute torque as a proportion of the converter's largest, which 95 % of the moves do
          not exceed
        - ``peak_of_range_max``: largest absolute torque as a proportion of the converter's largest
        - ``saturated``: moves in which the converter clipped, as a proportion
        - ``rest_torque_rms``: rms of the torque at rest, N m (N on a linear axis)
        - ``rest_torque_changes``: rms of its changes from sample to sample, N m (N on a linear axis)
        - ``rest_torque_changes_of_range``: the same as a proportion of the converter's largest torque

    margins : Margins or None
        Smallest margins of the tuned loops.
    lowest_mode : float or None
        Frequency at and above which a mode of half of the inertia, which the study lacks, leaves the loops stable, Hz.
    gain_margin_loop : GainMarginLoop or None
        The loop that has the worst gain margin.
    phase_margin_loop : PhaseMarginLoop or None
        The loop that has the worst phase margin.
    delay_margin_loop : DelayMarginLoop or None
        The loop that has the worst delay margin.
    sensitivity_loop : SensitivityLoop or None
        The loop that has the worst sensitivity.
    margins_by_condition : pandas.DataFrame or None
        Smallest margins under each condition, with conditions.

        - ``condition``: its name
        - ``gain``: gain margin; unknown where no loop has a limit, dB
        - ``phase``: phase margin; unknown where no loop has a limit, degrees
        - ``delay``: samples of delay until a loop is unstable; 10 means 10 or more, samples
        - ``sensitivity``: largest |S|, S = 1/(1 + L)
        - ``crossover``: highest frequency at which |L| = 1; 0 without one, Hz
        - ``stable``: whether no loop is unstable
        - ``machines``: machines that were examined

    wider_band_rate : float or None
        Rate of the goal with a band one count wider, where it is not met.
    delay_lost : float or None
        controller.delay from which on the goal seems lost; with conditions that of the condition under which it is lost
        first, samples.
    delay_lost_condition : str or None
        That condition, with conditions.
    lost_ages : pandas.DataFrame
        Age at which each goal is lost under each condition, of a study with ages.

        - ``goal``: its goal, of several
        - ``condition``: its condition, with conditions
        - ``lost``: youngest age that was tried at which less than asked for meets the goal, to 10 %; null: none; in the
          unit of ages
        - ``met_until``: age up to and including which the goal is shown to be met, at its confidence; null: not at the
          first
        - ``missed_from``: age from which on the goal is shown to be missed, at its confidence; null: none

    ages_tried_to : float or None
        Oldest age that was tried, of a study with ages, in the unit of ages.
    room : dict[str, list[float or None]]
        Range of each parameter in which the goal seems met, the others as tuned.
    robustness : pandas.DataFrame
        Rates at the tuned values with other seeds, spreads and delays.

        - ``premise``: what differs from the study
        - ``holds``: whether every goal is met under every condition
        - ``rate``: proportion of moves, or of machines, that meet the worst goal; of seeds the lowest
        - ``note``: what stayed, or why there is no rate

    alternatives : pandas.DataFrame
        Simpler and other controls at their own best values.

        - ``fixed``: parameters that are not tuned, with their values
        - ``gains``: its best values by parameter; none if none keeps the margins
        - ``status``: verdict on the goal
        - ``rate``: proportion of moves that meet the goal, with one-sided bounds
        - ``rate_low``: lower bound
        - ``rate_high``: upper bound
        - ``goal_name``: its goal, of several
        - ``condition``: its condition, with conditions
        - ``criterion``: quantity that is minimised; unknown for never

    limits : pandas.DataFrame
        Rates with each cause of failures switched off, that with none of them first.

        - ``cause``: cause of failures that is switched off
        - ``rate``: proportion of moves, or of machines, that meet the question; unknown if it is not simulated
        - ``goal``: its goal, of several
        - ``condition``: its condition, with conditions
        - ``rates``: the rates of all goals under all conditions, where there are several
        - ``gained``: machines, or trials, that meet the worst goal more often without the cause
        - ``lost``: machines, or trials, that meet it less often
        - ``p_value``: probability of as many gained if as many were to lose (sign test), for this row alone
        - ``shown``: whether it is shown to raise the rate, allowing for the number of causes
        - ``note``: what the rate does not show, what is assumed, or why there is none

    frontier : pandas.DataFrame
        Points of the search that no other point beats in both rate and criterion.

        - ``gains``: values by parameter
        - ``rate``: rate of the goal by the search, which is a little too good
        - ``criterion``: quantity that is minimised; unknown for never

    searched : Searched
        Size of the search.
    spent_trials : int
        Trials of all.
    left_out : list[str]
        Parts of the answer for which the budget was not enough.
    interrupted : bool
        Whether Ctrl-C ended it after the proof.
    """

    _records = {"nearest": Nearest, "proof": Proof, "needed": Needed, "worst": Worst, "margins": Margins, "gain_margin_loop": GainMarginLoop, "phase_margin_loop": PhaseMarginLoop, "delay_margin_loop": DelayMarginLoop, "sensitivity_loop": SensitivityLoop, "searched": Searched}

    goal: str
    status: Literal["met", "unreachable", "undecided"]
    gains: dict[str, float | None]
    refusals: pandas.DataFrame
    nearest: Nearest | None
    claims: pandas.DataFrame
    obstacles: list[str]
    proof: Proof | None
    needed: Needed | None
    at_edges: list[str]
    worst: Worst | None
    behaviour: pandas.DataFrame
    margins: Margins | None
    lowest_mode: float | None
    gain_margin_loop: GainMarginLoop | None
    phase_margin_loop: PhaseMarginLoop | None
    delay_margin_loop: DelayMarginLoop | None
    sensitivity_loop: SensitivityLoop | None
    margins_by_condition: pandas.DataFrame | None
    wider_band_rate: float | None
    delay_lost: float | None
    delay_lost_condition: str | None
    lost_ages: pandas.DataFrame
    ages_tried_to: float | None
    room: dict[str, list[float | None]]
    robustness: pandas.DataFrame
    alternatives: pandas.DataFrame
    limits: pandas.DataFrame
    frontier: pandas.DataFrame
    searched: Searched
    spent_trials: int
    left_out: list[str]
    interrupted: bool


class LimitsAnswer(Answer):
    """What stands between a point and its goal.

    Attributes
    ----------
    limits : pandas.DataFrame
        Rates with each cause of failures switched off, that with none of them first.

        - ``cause``: cause of failures that is switched off
        - ``rate``: proportion of moves, or of machines, that meet the question; unknown if it is not simulated
        - ``goal``: its goal, of several
        - ``condition``: its condition, with conditions
        - ``rates``: the rates of all goals under all conditions, where there are several
        - ``gained``: machines, or trials, that meet the worst goal more often without the cause
        - ``lost``: machines, or trials, that meet it less often
        - ``p_value``: probability of as many gained if as many were to lose (sign test), for this row alone
        - ``shown``: whether it is shown to raise the rate, allowing for the number of causes
        - ``note``: what the rate does not show, what is assumed, or why there is none

    additions : pandas.DataFrame
        Rates with an effect added to those of the study.

        - ``effect``: effect that is added
        - ``rate``: proportion of moves, or of machines, that meet the question; unknown if it is not simulated
        - ``goal``: its goal, of several
        - ``condition``: its condition, with conditions
        - ``rates``: the rates of all goals under all conditions, where there are several
        - ``gained``: machines, or trials, that meet the worst goal more often without the cause
        - ``lost``: machines, or trials, that meet it less often
        - ``p_value``: probability of as many gained if as many were to lose (sign test), for this row alone
        - ``shown``: whether it is shown to raise the rate, allowing for the number of causes
        - ``note``: what the rate does not show, what is assumed, or why there is none

    """

    limits: pandas.DataFrame
    additions: pandas.DataFrame


class Again(Record):
    """The worst machine of the study, judged by new trials.

    Attributes
    ----------
    condition : str or None
        The condition under which it runs, in a study with conditions.
    goal : str or None
        The goal that its moves meet the least often, of several.
    moves : int
        Moves by which the machine is judged.
    met : float or None
        Proportion of these moves that meet the goal.
    """

    condition: str | None
    goal: str | None
    moves: int
    met: float | None


class Box(Record):
    """The worst machine in the box of the central 99.9 % of each input.

    Attributes
    ----------
    machine : int
        Machine of the study with its profiles; 0 without machines.
    trial : int
        Its worst trial, of its manifest.
    condition : str or None
        The condition under which it runs, in a study with conditions.
    goal : str or None
        The goal that its moves meet the least often, of several.
    moves : int
        Moves by which the machine is judged.
    met : float or None
        Proportion of these moves that meet the goal.
    inputs : dict[str, float or None]
        The quantities that differ between machines, by parameter.
    quantiles : list[float or None]
        Their quantiles.
    of_study : bool
        Whether it is the worst machine of the study.
    """

    machine: int
    trial: int
    condition: str | None
    goal: str | None
    moves: int
    met: float | None
    inputs: dict[str, float | None]
    quantiles: list[float | None]
    of_study: bool


class Likely(Record):
    """The worst of the likely machines.

    Attributes
    ----------
    machine : int
        Machine of the study with its profiles; 0 without machines.
    trial : int
        Its worst trial, of its manifest.
    condition : str or None
        The condition under which it runs, in a study with conditions.
    goal : str or None
        The goal that its moves meet the least often, of several.
    moves : int
        Moves by which the machine is judged.
    met : float or None
        Proportion of these moves that meet the goal.
    inputs : dict[str, float or None]
        The quantities that differ between machines, by parameter.
    quantiles : list[float or None]
        Their quantiles.
    in_box : bool
        Whether it is the machine of the box.
    """

    machine: int
    trial: int
    condition: str | None
    goal: str | None
    moves: int
    met: float | None
    inputs: dict[str, float | None]
    quantiles: list[float | None]
    in_box: bool


class WorstAnswer(Answer):
    """The machine that a gain suits worst.

    Attributes
    ----------
    goal : str or None
        Its goal, of several.
    condition : str or None
        Its condition, with conditions.
    machine : int
        Number of the machine in the study, or of its trial where no trials share a machine.
    trial : int
        Its worst trial.
    met : float or None
        Proportion of its moves that meet the goal.
    inputs : dict[str, float or None]
        What it has drawn, by parameter.
    again : Again
        The worst machine of the study, judged by new trials.
    box : Box
        The worst machine in the box of the central 99.9 % of each input.
    likely : Likely
        The worst of the likely machines.
    """

    _records = {"again": Again, "box": Box, "likely": Likely}

    goal: str | None
    condition: str | None
    machine: int
    trial: int
    met: float | None
    inputs: dict[str, float | None]
    again: Again
    box: Box
    likely: Likely


class Budget(Record):
    """What it could spend.

    Attributes
    ----------
    trials : int or None
        Trials of this run.
    seconds : float or None
        Time of this run, s.
    """

    trials: int | None
    seconds: float | None


class Plain(Record):
    """What the plain trials show.

    Attributes
    ----------
    trials : int
        Trials drawn from their own distribution.
    failures : int
        Those with a move that failed.
    high : float or None
        Upper bound by these alone.
    """

    trials: int
    failures: int
    high: float | None


class Machines(Record):
    """Machines that carry the probability.

    Attributes
    ----------
    examined : int
        Machines, drawn from the failures.
    moves_each : int
        New moves of each.
    median_rate : float or None
        Median of their proportions of failing moves.
    mostly_failing : float or None
        Proportion of the failures on machines that fail in most of their moves.
    probability_of_one : float or None
        Probability of such a machine.
    """

    examined: int
    moves_each: int
    median_rate: float | None
    mostly_failing: float | None
    probability_of_one: float | None


class RareAnswer(Answer):
    """The probability of a rare failure.

    Attributes
    ----------
    probability : float or None
        Probability of the event in a move; unknown where no failure was weighted.
    low : float or None
        Its lower bound.
    high : float or None
        Its upper bound.
    trials : int
        Trials that were run.
    status : Literal["estimated", "undecided"]
        Whether the bounds are as narrow as asked.
    reason : str
        Why it ended.
    premise : str or None
        What a bound assumes.
    budget : Budget
        What it could spend.
    confidence : float or None
        Confidence of both bounds together.
    seconds : float or None
        Time of all runs, s.
    event : str
        The event; goal, success: it is missed.
    point : int
        Number of the design point.
    label : str
        Label of the design point.
    world : int or None
        The world, of a study with worlds.
    condition : str or None
        The condition, of a study with conditions.
    plain : Plain
        What the plain trials show.
    scores : pandas.DataFrame
        Searches for failures along scores.

        - ``score``: quantity that leads towards failures
        - ``reached``: whether failures were reached
        - ``levels``: levels of the search
        - ``probability``: probability of the last level, without bounds
        - ``trials``: trials of the search

    values_ : pandas.DataFrame
        Single values at which failures are frequent.

        - ``parameter``: parameter with single values
        - ``value``: value at which failures are frequent
        - ``probability``: probability of the value
        - ``failures``: trials at the value that failed
        - ``trials``: trials at the value

    inputs : pandas.DataFrame
        Inputs that differ between trials, the most shifted first.

        - ``parameter``: dotted path of the parameter
        - ``unit``: its unit
        - ``shift``: standard deviations by which failures lie above the median of all trials
        - ``failures``.* (low, median, high): quantiles in failures
        - ``usual``.* (low, median, high): quantiles in all trials

    machines : Machines or None
        Machines that carry the probability.
    drawn : int
        Weighted trials in the file.
    failures_drawn : int
        Those that failed.
    """

    _records = {"budget": Budget, "plain": Plain, "machines": Machines}

    probability: float | None
    low: float | None
    high: float | None
    trials: int
    status: Literal["estimated", "undecided"]
    reason: str
    premise: str | None
    budget: Budget
    confidence: float | None
    seconds: float | None
    event: str
    point: int
    label: str
    world: int | None
    condition: str | None
    plain: Plain
    scores: pandas.DataFrame
    values_: pandas.DataFrame
    inputs: pandas.DataFrame
    machines: Machines | None
    drawn: int
    failures_drawn: int


class ParametersAnswer(Answer):
    """What a manifest can say.

    Attributes
    ----------
    parameters : pandas.DataFrame
        Parameters and their defaults.

        - ``name``: dotted path in a manifest
        - ``unit``: 1 where it is dimensionless
        - ``default``: value where a manifest has none, or the range over the guides
        - ``allowed``: words, or the range of numbers
        - ``source``: source of the default
        - ``meaning``: what it is

    distributions : pandas.DataFrame
        What may stand in place of any number.

        - ``name``: key of the distribution
        - ``written``: as in a manifest
        - ``meaning``: what it is

    keys_ : pandas.DataFrame
        Other keys of a manifest.

        - ``name``: dotted path in a manifest
        - ``required``: whether every manifest has it
        - ``meaning``: what it is

    """

    parameters: pandas.DataFrame
    distributions: pandas.DataFrame
    keys_: pandas.DataFrame


class ParametersGuidesAnswer(Answer):
    """Starting values of guides and bearings.

    Attributes
    ----------
    quantities : pandas.DataFrame
        Quantities of the guides.

        - ``guide``: name of the guide
        - ``quantity``: what is between low and high
        - ``unit``: 1 where it is dimensionless
        - ``low``: least value to expect, in the unit
        - ``high``: largest value to expect, in the unit
        - ``origin``: where the numbers come from
        - ``source``: publication and place, or reason of an assumption

    parameters : pandas.DataFrame
        Parameters of the guides with their usual mass and preload.

        - ``guide``: name of the guide
        - ``mass``: mass or moment of inertia that it moves
        - ``mass_unit``: unit of the mass
        - ``preload``: preload; null where friction does not depend on it, N
        - ``parameter``: what is between low and high
        - ``unit``: 1 where it is dimensionless
        - ``low``: least value to expect, in the unit
        - ``high``: largest value to expect, in the unit
        - ``origin``: where the numbers come from

    """

    quantities: pandas.DataFrame
    parameters: pandas.DataFrame


class JerksAnswer(Answer):
    """Rate, intervals and trend of the jerks of each design point.

    Attributes
    ----------
    name : str
        Name of the study.
    confidence : float or None
        Confidence of all bounds.
    points : pandas.DataFrame
        The design points.

        - ``point``: number of the design point
        - ``label``: label of the design point, with the condition
        - ``condition``: condition that the trials are under
        - ``trials``: trials of the design point
        - ``moves``: moves of all trials
        - ``arrived``: moves that arrived; only these can jerk
        - ``lost``: moves that became non-finite after arrival; excluded
        - ``trials_with_jerks``: trials with at least one jerk
        - ``jerks``: jerks of all trials
        - ``rates``: rate by time
          - ``from``: start of the range, since arrival, s
          - ``to``: end of the range, since arrival; belongs to the next, s
          - ``moves``: moves in which a jerk could have begun in the range
          - ``exposure``: time in which a jerk could have begun, summed over all moves, s
          - ``jerks``: jerks that began in the range
          - ``rate``: jerks per exposure, with Garwood's bounds, widened by the dispersion, 1/s
          - ``rate_low``: lower bound, 1/s
          - ``rate_high``: upper bound, 1/s
          - ``poisson_low``: lower bound of the rate of independent jerks (Garwood), 1/s
          - ``poisson_high``: its upper bound, 1/s
          - ``dispersion``: variance of the jerks of a trial, divided by that of independent ones
        - ``interval``.* (n, mean, p05, p05_low, p05_high, p25, p25_low, p25_high, p50, p50_low, p50_high, p75, p75_low,
          p75_high, p95, p95_low, p95_high): times between the onsets of successive jerks of a move
        - ``slowing``.* (moves, tested, slowing, quickening, score, stouffer, p_value, permutations): trend of the
          intervals between the jerks of a move
        - ``agreement``.* (hits, jerks, proportion, proportion_low, proportion_high, independent): jerks in the
          direction of their holding torque
        - ``magnitude``.* (counts, mean, max, median_duration, longest_duration, one_count): largest |error| of the
          jerks
        - ``creep``.* (trials, not_applicable, ended, predicted, lasting, lasting_predicted, median_deviation,
          largest_deviation, too_short, unsteady): comparison with the closed form of creep at constant torque

    """

    name: str
    confidence: float | None
    points: pandas.DataFrame


class Baseline(Record):
    """The file of the baseline.

    Attributes
    ----------
    path : str
        Path of the file.
    name : str
        Name of the study.
    zerocount_version : str
        Version of the program.
    git_commit : str
        Commit of the program.
    created : str
        Time of the run, UTC.
    engine : str
        Engine that simulated the trials.
    seed : int
        Seed of the study.
    trials : int
        Trials per design point.
    """

    path: str
    name: str
    zerocount_version: str
    git_commit: str
    created: str
    engine: str
    seed: int
    trials: int


class Current(Record):
    """The file that is compared with it.

    Attributes
    ----------
    path : str
        Path of the file.
    name : str
        Name of the study.
    zerocount_version : str
        Version of the program.
    git_commit : str
        Commit of the program.
    created : str
        Time of the run, UTC.
    engine : str
        Engine that simulated the trials.
    seed : int
        Seed of the study.
    trials : int
        Trials per design point.
    """

    path: str
    name: str
    zerocount_version: str
    git_commit: str
    created: str
    engine: str
    seed: int
    trials: int


class Counts(Record):
    """Number of verdicts.

    Attributes
    ----------
    passed : int
        Judgements that passed.
    regression : int
        Worse, or a requirement that is not met.
    changed : int
        Better, where every change fails.
    inconclusive : int
        Judgements that are open.
    not_measured : int
        Judgements without enough values.
    worse : int
        Measures that are worse.
    better : int
        Measures that are better.
    equivalent : int
        Measures that are equivalent.
    not_worse : int
        Measures that are better or equivalent.
    undecided : int
        Measures whose change is open.
    """

    passed: int
    regression: int
    changed: int
    inconclusive: int
    not_measured: int
    worse: int
    better: int
    equivalent: int
    not_worse: int
    undecided: int


class CompareAnswer(Answer):
    """Whether a study is as good as its baseline.

    Attributes
    ----------
    verdict : Literal["regression", "changed", "inconclusive", "passed", "not measured"]
        Verdict of the gate.
    baseline : Baseline
        The file of the baseline.
    current : Current
        The file that is compared with it.
    baseline_label : str or None
        Label of the baseline's point, where two points of one file are compared.
    layer : Literal["bits", "paired", "two_samples"]
        What the files have in common.
    layer_reason : str
        Why they are compared so.
    equal_to_the_bit : bool
        Whether every dataset is equal to the bit.
    first_difference : str
        First dataset that differs, with the place; empty if not searched for.
    goal : str or None
        The goal by which the points are judged.
    changed_inputs : list[str]
        Drawn parameters whose values differ on the same draws.
    notes : list[str]
        What else the reader should know.
    manifest_differences : pandas.DataFrame
        Keys whose values differ; a value is empty where its key is absent.

        - ``key``: dotted path
        - ``baseline``: value in the baseline
        - ``current``: value in the file

    confidence : float or None
        Confidence of each bound.
    false_discovery_rate : float or None
        Accepted proportion of false discoveries.
    tests : int
        Tests over which the false discoveries are controlled.
    counts : Counts
        Number of verdicts.
    trials_to_decide : int or None
        Trials per design point that decide the whole.
    decision_probability : float or None
        Probability with which these decide.
    max_trials_to_decide : float or None
        Trials per design point, the most that were tried.
    points : pandas.DataFrame
        The design points.

        - ``label``: label of the design point, with the condition
        - ``condition``: condition that the trials are under
        - ``verdict``: verdict of the gate
        - ``baseline_point``: number of the point in the baseline
        - ``current_point``: number of the point in the file
        - ``baseline_trials``: trials of the baseline
        - ``current_trials``: trials of the file
        - ``pairs``: trials that were compared one by one
        - ``baseline_undecided``.* (moves, off_target, still_falling, falling_with_ripple, about_to_arrive): undecided
          moves of the baseline
        - ``current_undecided``.* (moves, off_target, still_falling, falling_with_ripple, about_to_arrive): undecided
          moves of the file
        - ``measures``: comparison of each measure
          - ``measure``: name of the measure
          - ``unit``: unit of all values
          - ``verdict``: change that the data show
          - ``gate``: verdict of the gate
          - ``baseline``: proportion or mean in the baseline
          - ``current``: proportion or mean in the file
          - ``baseline_n``: trials with a value in the baseline
          - ``current_n``: trials with a value in the file
          - ``effect``: change for the worse, with one-sided bounds
          - ``effect_low``: lower bound
          - ``effect_high``: upper bound
          - ``margin``: largest accepted effect
          - ``changed_fails``: whether a change for the better beyond the margin fails too
          - ``detectable_change``: smallest change for the worse that these trials find
          - ``test``: test that gives p
          - ``p``: p-value against a change for the worse
          - ``adjusted_p``: p against a change for the worse beyond the margin, with control of the false discoveries
          - ``improvement_p``: p-value against a change for the better
          - ``adjusted_improvement_p``: p against a change for the better beyond the margin, with control of the false
            discoveries
          - ``trials_to_decide``: trials per design point that decide an inconclusive measure
          - ``decided_margin``: any larger margin is decided by these trials
          - ``max_trials_margin``: smallest margin that max_trials_to_decide trials decide
          - ``note``: reason or remark
        - ``requirements``: absolute requirements
          - ``require``: the requirement as it was given
          - ``quantity``: quantity that is required
          - ``unit``: unit of the limit and the value
          - ``verdict``: verdict of the gate
          - ``limit``: limit of the value
          - ``value``: value in the file
          - ``n``: trials or moves from which the value is computed
          - ``bounds``: one-sided bounds, low and high: of the value, or of the proportion within the limit of a
            quantile
          - ``trials_to_decide``: trials per design point that decide the requirement
        - ``goal``.* (baseline, current): verdicts on the goal, where the points are judged by one
        - ``goals``: verdicts on each of several goals
          - ``name``: name of the goal
          - ``baseline``: verdict on the baseline
          - ``current``: verdict on the file

    """

    _records = {"baseline": Baseline, "current": Current, "counts": Counts}

    verdict: Literal["regression", "changed", "inconclusive", "passed", "not measured"]
    baseline: Baseline
    current: Current
    baseline_label: str | None
    layer: Literal["bits", "paired", "two_samples"]
    layer_reason: str
    equal_to_the_bit: bool
    first_difference: str
    goal: str | None
    changed_inputs: list[str]
    notes: list[str]
    manifest_differences: pandas.DataFrame
    confidence: float | None
    false_discovery_rate: float | None
    tests: int
    counts: Counts
    trials_to_decide: int | None
    decision_probability: float | None
    max_trials_to_decide: float | None
    points: pandas.DataFrame


class HistoryAnswer(Answer):
    """Results over time, and when they changed.

    Attributes
    ----------
    false_alarm_probability : float or None
        Probability of a change in any series without cause.
    false_alarm_runs : float or None
        Runs within which it has this probability.
    threshold : float or None
        Limit of |z| of the test levels.
    max_p : float or None
        Limit of p of the test baseline.
    series : pandas.DataFrame
        A measure at a point in all runs.

        - ``study``: name of the study
        - ``series_sha256``: hash of the question, equal for all runs
        - ``point``: label of the design point
        - ``measure``: name of the measure
        - ``unit``: unit of the values
        - ``test``: how the series is tested
        - ``runs``: runs by time
          - ``created``: time of the run, UTC
          - ``git_commit``: commit of the program
          - ``zerocount_version``: version of the program
          - ``study_sha256``: hash of the study
          - ``seed``: seed of the study, decimal
          - ``trials``: trials per design point
          - ``n``: trials or values from which the value is computed
          - ``value``: value of the measure, in its unit, with 95 % bounds
          - ``value_low``: lower bound
          - ``value_high``: upper bound
          - ``comparison``.* (verdict, baseline, effect, effect_low, effect_high, margin, p, baseline_created,
            baseline_commit): comparison with the baseline
          - ``changed``: changes after which this is the first run
          - ``significant``: changes that are significant since this run
        - ``changes``: changes that are significant
          - ``before``: level before the change
          - ``after``: level after the change
          - ``since_baseline``: whether the change lies between the baseline and the first run
          - ``last_run_before``.* (created, git_commit): last run, or the baseline, before the change
          - ``first_run_after``.* (created, git_commit): first run after the change
          - ``significant_since``.* (created, git_commit): run at which the change was significant
          - ``z``: signed root of the likelihood ratio statistic, of the test levels
          - ``p``: two-sided p-value, of the test baseline
          - ``sentence``: the change in words

    """

    false_alarm_probability: float | None
    false_alarm_runs: float | None
    threshold: float | None
    max_p: float | None
    series: pandas.DataFrame


class MonitorAnswer(Answer):
    """Whether a machine has changed.

    Attributes
    ----------
    status : Literal["changed", "unchanged", "undecided"]
        Whether the machine changed.
    measure : str or None
        Measure of the first alarm; null: none.
    direction : Literal["higher", "lower"] or None
        Direction of its change; null: no alarm.
    since : int or None
        Estimated first move of the change, from 1; null: no alarm.
    alarm_at : int or None
        Move of the alarm, from 1; null: none.
    moves : int
        Moves seen.
    evidence : float or None
        e-value against no change, the largest until now; the alarm is at 1/alarm.
    alarm : float or None
        Largest probability of a false alarm within any number of moves.
    block : int
        Consecutive moves that are one value.
    group : str or None
        Column of the groups that are one value each; null: none.
    values_ : int
        Values that were compared: moves, blocks or groups.
    baseline : str
        File of the baseline.
    log : str
        File of the moves.
    baseline_moves : int
        Moves of the baseline.
    baseline_machines : int or None
        Simulated machines of the baseline; null: it was measured.
    repeated : int
        First moves that have the same values as the first ones of a measured baseline.
    unused : list[str]
        Columns of the moves that nothing is compared with.
    alike : str
        What moves are compared by; empty: all with all.
    unlike : int
        Moves that the baseline has none like, which are not compared.
    measures : pandas.DataFrame
        Each measure.

        - ``measure``: name of the measure
        - ``unit``: its unit
        - ``baseline``: median of the baseline, of a quality its proportion; null: never, or one for each like: see
          `likes`
        - ``moves``: median of the moves, of a quality its proportion, since the change if there is one; null: none, or
          never
        - ``evidence``: largest capital of the bets on a change of the measure, as a part of the alarm's scale
        - ``direction``: direction of the change; null: no alarm
        - ``since``: first move of the change, from 1; null: no alarm
        - ``alarm_at``: move of the alarm, from 1; null: none
        - ``correlation``: rank correlation of successive values of the baseline; null: of a simulated one
        - ``dependence``: p-value of the order of the baseline's values, if they are exchangeable; null: of a simulated
          one
        - ``seen_after``: moves after which a change of the asked size, added to each value or as a factor of it, would
          have been seen with 90 %, where there are as many; null: later, or not asked

    not_judged : pandas.DataFrame
        Measures about which 'unchanged' says nothing.

        - ``measure``: name of the measure
        - ``why``: missing: the moves have no such column; not_in_baseline: the baseline has none; accumulates: it grows
          from move to move, and --measure does not name it; no_change_to_see: it has no size of change, see `change`
        - ``near``: column of the side that lacks the measure whose name resembles it; null: none

    likes : pandas.DataFrame
        Medians of measures that differ from one kind of moves to another more than within.

        - ``measure``: name of the measure
        - ``like``: what these moves have in common
        - ``baseline``: their median in the baseline; null: never
        - ``baseline_moves``: number of moves of that median
        - ``median``: their median in the log, since the change if there is one; null: none, or never
        - ``moves``: number of moves of that median

    told : Literal["one", "several", "none", "unknown"] or None
        What is known of the parameters of the model after an alarm; null: not asked.
    parameters_since : int or None
        First move of those that the parameters explain, from 1; null: not asked.
    tried : list[str]
        Parameters of the model that were tried and act on the measures.
    untried : list[str]
        Parameters for which the budget did not suffice.
    parameters : pandas.DataFrame
        Parameters of the model that explain the change.

        - ``parameter``: dotted path
        - ``factor``: most likely factor by which it changed; null: something was added
        - ``low``: low end of the 95 % interval of the factor
        - ``high``: high end of it
        - ``amount``: most likely amount that was added, in its unit; null: it was multiplied
        - ``amount_low``: low end of the 95 % interval of the amount
        - ``amount_high``: high end of it
        - ``probability``: that it is this parameter, if it is one of those tried

    """

    status: Literal["changed", "unchanged", "undecided"]
    measure: str | None
    direction: Literal["higher", "lower"] | None
    since: int | None
    alarm_at: int | None
    moves: int
    evidence: float | None
    alarm: float | None
    block: int
    group: str | None
    values_: int
    baseline: str
    log: str
    baseline_moves: int
    baseline_machines: int | None
    repeated: int
    unused: list[str]
    alike: str
    unlike: int
    measures: pandas.DataFrame
    not_judged: pandas.DataFrame
    likes: pandas.DataFrame
    told: Literal["one", "several", "none", "unknown"] | None
    parameters_since: int | None
    tried: list[str]
    untried: list[str]
    parameters: pandas.DataFrame


class AcceptAnswer(Answer):
    """Whether machines that were built meet the goal, and the prediction.

    Attributes
    ----------
    status : Literal["accepted", "rejected", "undecided"]
        Verdict on the machines.
    judged : Literal["all_machines", "these_machines"]
        Machines that the goals are judged for.
    needed_machines : int or None
        Machines, with as many moves each, that would decide the goals for all machines; null: they are decided, or no
        number is known.
    study : str
        The results file of the prediction.
    point : str
        Label of the design point.
    simulated_machines : int
        Machines of the prediction.
    goals : pandas.DataFrame
        Each goal.

        - ``goal``: name of the goal
        - ``status``: verdict on the machines by the goal and its prediction
        - ``goal_status``: verdict on the goal alone, whatever was predicted
        - ``wanted``: proportion of moves that should meet it
        - ``predicted``: proportion of the simulated moves that meet it; bounds: 95 % interval for as many machines and
          moves as are compared
        - ``predicted_low``: lower bound
        - ``predicted_high``: upper bound
        - ``measured``: proportion of the measured moves that meet it, with one-sided bounds of these machines
        - ``measured_low``: lower bound
        - ``measured_high``: upper bound
        - ``met``: measured moves that meet it
        - ``moves``: measured moves
        - ``agreement``: whether these machines are like those simulated
        - ``p_value``: two-sided p-value of the agreement
        - ``like_worlds``: worlds of the study that agree with the machines; null: it has no worlds
        - ``compared_moves``: first moves of each machine that are compared
        - ``all_machines``: proportion of moves of all machines of which these are a sample, with one-sided bounds
        - ``all_machines_low``: lower bound
        - ``all_machines_high``: upper bound
        - ``machines_predicted``: proportion of machines that meet it in the wanted proportion of moves, with one-sided
          bounds; null: the goal does not ask for machines
        - ``machines_predicted_low``: lower bound
        - ``machines_predicted_high``: upper bound
        - ``machines_measured``: that proportion of the measured machines, with one-sided bounds
        - ``machines_measured_low``: lower bound
        - ``machines_measured_high``: upper bound

    standard : pandas.DataFrame
        Values of the axis; empty without a sequence, or without the columns final_error and move in every log.

        - ``value``: name of the value of the axis
        - ``symbol``: in the standard
        - ``predicted``: median of the simulated runs, count
        - ``predicted_low``: 95 % of the simulated runs have more, count
        - ``predicted_high``: and less, count
        - ``measured``: value of each measured run, count
        - ``within``: measured runs in the predicted interval
        - ``runs``: measured runs

    standard_lacks : str
        Why there are no values of ISO 230-2: the column that a log lacks; empty: there are, or the study has no
        sequence.
    machines : pandas.DataFrame
        Each machine that was measured.

        - ``machine``: its log
        - ``moves``: its moves that each goal is about, in the order of the goals
        - ``met``: its moves that meet each goal, in the same order

    assumed : list[str]
        Effects that the prediction leaves out because its manifest does not name them.
    """

    status: Literal["accepted", "rejected", "undecided"]
    judged: Literal["all_machines", "these_machines"]
    needed_machines: int | None
    study: str
    point: str
    simulated_machines: int
    goals: pandas.DataFrame
    standard: pandas.DataFrame
    standard_lacks: str
    machines: pandas.DataFrame
    assumed: list[str]


class PlanGoalAnswer(Answer):
    """The smallest studies that can meet the goal of a manifest.

    Attributes
    ----------
    goal : str
        The goal in words.
    worlds : int
        Worlds; 0 without worlds.
    plans : pandas.DataFrame
        Studies, if no move misses the goal.

        - ``machine_count``: number of machines; 0 without machines
        - ``trials``: trials of a design point
        - ``seconds``: computing time with all cores of this machine; of goals on machines, s

    """

    goal: str
    worlds: int
    plans: pandas.DataFrame


class PlanPilotAnswer(Answer):
    """The study that decides the goal, by the results of a small one.

    Attributes
    ----------
    goal : str
        The goal in words.
    status : Literal["met", "missed", "undecided"]
        Verdict on the goal.
    needed : Needed or None
        Study that would decide the goal.
    probability : float or None
        Probability with which it decides.
    studies : pandas.DataFrame or None
        Studies that decide it; of goals on machines.

        - ``machine_count``: number of machines; 0 without machines
        - ``trials``: trials of a design point
        - ``seconds``: computing time with all cores of this machine; of goals on machines, s

    """

    _records = {"needed": Needed}

    goal: str
    status: Literal["met", "missed", "undecided"]
    needed: Needed | None
    probability: float | None
    studies: pandas.DataFrame | None


class Halfwidth(Record):
    """Plan of the bounds of a rate.

    Attributes
    ----------
    halfwidth : float or None
        half-width of the bounds.
    rate : float or None
        Assumed rate.
    machine_sd : float or None
        Standard deviation of the success probability between machines.
    machine_plans : pandas.DataFrame
        Machines and trials; none without machine_sd.

        - ``machine_count``: number of machines
        - ``trials_per_machine``: trials on each
        - ``trials``: trials on all machines

    trials : int or None
        Trials without machines, decided beforehand.
    trials_with_stop : int or None
        Trials without machines, decided by the outcomes.
    """

    halfwidth: float | None
    rate: float | None
    machine_sd: float | None
    machine_plans: pandas.DataFrame
    trials: int | None
    trials_with_stop: int | None


class PlanSuccessAnswer(Answer):
    """Trials that show a proportion of successful axes.

    Attributes
    ----------
    confidence : float or None
        Confidence of the claim, or of the bounds.
    success : float or None
        Proportion of axes to be shown to succeed.
    true_success : float or None
        Assumed true proportion.
    power : float or None
        Probability that is asked for.
    plans : pandas.DataFrame
        Plans by the number of failures.

        - ``failures``: failures at most
        - ``trials``: trials
        - ``chance``: probability that the plan shows the claim, if true_success is the proportion
        - ``has_power``: whether this probability is at least the power that is asked for

    halfwidth : Halfwidth or None
        Plan of the bounds of a rate.
    """

    _records = {"halfwidth": Halfwidth}

    confidence: float | None
    success: float | None
    true_success: float | None
    power: float | None
    plans: pandas.DataFrame
    halfwidth: Halfwidth | None


class PlanMachinesAnswer(Answer):
    """Machines and trials that show a proportion of successful machines.

    Attributes
    ----------
    confidence : float or None
        Confidence of the claim, or of the bounds.
    success : float or None
        Proportion of its moves in which a machine holds zero.
    machines_share : float or None
        Proportion of machines to be shown to succeed.
    machine_plans : pandas.DataFrame
        Machines and trials, if no trial fails.

        - ``machine_count``: number of machines
        - ``trials_per_machine``: trials on each
        - ``trials``: trials on all machines

    halfwidth : Halfwidth or None
        Plan of the bounds of a rate.
    """

    _records = {"halfwidth": Halfwidth}

    confidence: float | None
    success: float | None
    machines_share: float | None
    machine_plans: pandas.DataFrame
    halfwidth: Halfwidth | None


class PlanHalfwidthAnswer(Answer):
    """Trials that bring the bounds of a rate within a half-width.

    Attributes
    ----------
    confidence : float or None
        Confidence of the claim, or of the bounds.
    halfwidth : Halfwidth or None
        Plan of the bounds of a rate.
    """

    _records = {"halfwidth": Halfwidth}

    confidence: float | None
    halfwidth: Halfwidth | None


class PlanEquivalenceAnswer(Answer):
    """Trials that show that two equal studies are equivalent.

    Attributes
    ----------
    confidence : float or None
        Confidence of each bound.
    power : float or None
        Probability with which equivalence is shown.
    pilot_trials : int
        Trials of the pilot per design point.
    trials : int or None
        Trials of each study per design point; unknown if max_trials do not suffice.
    max_trials : int
        The most trials that were tried.
    measures : pandas.DataFrame
        Measures at the design points.

        - ``point``: label of the design point, with the condition
        - ``condition``: its trials are under it; absent without conditions
        - ``measure``: name of the measure
        - ``unit``: its unit
        - ``value``: its value in the pilot, in its unit
        - ``margin``: largest accepted difference, in its unit
        - ``trials``: trials of each study per design point for this measure alone

    unplanned : pandas.DataFrame
        Measures of which too few trials of the pilot have a value.

        - ``point``: label of the design point, with the condition
        - ``condition``: its trials are under it; absent without conditions
        - ``measure``: name of the measure

    """

    confidence: float | None
    power: float | None
    pilot_trials: int
    trials: int | None
    max_trials: int
    measures: pandas.DataFrame
    unplanned: pandas.DataFrame


class SensitivityAnswer(Answer):
    """Which random parameters influence the outputs of the trials.

    Attributes
    ----------
    name : str
        Name of the study.
    design_is_saltelli : bool
        Whether the design is saltelli, and there are total indices.
    confidence : float or None
        Confidence of all bounds, each by itself.
    points : pandas.DataFrame
        The design points.

        - ``point``: number of the design point
        - ``label``: label of the design point, with the condition
        - ``condition``: condition that the trials are under
        - ``outputs``: outputs of the trials
          - ``output``: name of the output
          - ``unit``: unit of the mean and the standard deviation
          - ``meaning``: what the output is
          - ``estimated``: whether the factors could be estimated
          - ``conclusion``: which factors matter, which do not, and what stays open
          - ``notes``: what limits these numbers
          - ``trials``: trials, or worlds, that are used
          - ``mean``: mean of the output, in its unit
          - ``standard_deviation``: standard deviation of the output, in its unit
          - ``factors``: what varies in the trials, strongest first
            - ``name``: dotted path of the parameter, or what is drawn within trials
            - ``matters``: whether it is shown to have an influence
            - ``total``: total Sobol' index
            - ``total_low``: lower bound
            - ``total_high``: upper bound
            - ``first_order``: first-order Sobol' index
            - ``first_order_low``: lower bound
            - ``first_order_high``: upper bound
            - ``rank_correlation``: Spearman's rank correlation
            - ``rank_correlation_low``: lower bound
            - ``rank_correlation_high``: upper bound
            - ``partial_rank_correlation``: rank correlation after the effect of the other factors is removed
            - ``partial_rank_correlation_low``: lower bound
            - ``partial_rank_correlation_high``: upper bound
            - ``log_odds``: change of ln(p/(1 - p)) over one standard deviation of the factor, p the proportion of yes
            - ``log_odds_low``: lower bound
            - ``log_odds_high``: upper bound
          - ``left_out``: factors without numbers
            - ``name``: name of the factor
            - ``reason``: why it has no numbers

    """

    name: str
    design_is_saltelli: bool
    confidence: float | None
    points: pandas.DataFrame


class Parts(Record):
    """Parts of an array job.

    Attributes
    ----------
    all : int
        Parts of the array job.
    complete : int
        Parts with all their trials.
    running : int
        Parts that a process runs.
    interrupted : int
        Parts with finished trials that no process runs.
    waiting : int
        Parts that have not begun.
    """

    all: int
    complete: int
    running: int
    interrupted: int
    waiting: int


class StatusAnswer(Answer):
    """Progress of a run or an array job.

    Attributes
    ----------
    complete : bool
        Whether the results file is complete.
    name : str
        Name of the study; empty if no file could be read.
    running : bool
        Whether a process runs it.
    trials : int
        Trials of the study; the maximum with 'stop'.
    finished : int
        Trials in complete files.
    shards : int
        Finished shards, without those of complete parts.
    rate : float or None
        Sum of the mean rates of the processes that run, 1/s.
    remaining : float or None
        Time to go at this rate, s.
    problems : list[str]
        Files that cannot be read, or were set aside as damaged.
    parts : Parts or None
        Parts of an array job.
    """

    _records = {"parts": Parts}

    complete: bool
    name: str
    running: bool
    trials: int
    finished: int
    shards: int
    rate: float | None
    remaining: float | None
    problems: list[str]
    parts: Parts | None


PlanAnswer = Union[PlanGoalAnswer, PlanPilotAnswer, PlanSuccessAnswer, PlanMachinesAnswer, PlanHalfwidthAnswer, PlanEquivalenceAnswer]


TYPES: dict[str, type[Answer]] = {
    "check": CheckAnswer,
    "summary": SummaryAnswer,
    "verify": VerifyAnswer,
    "experiment": ExperimentAnswer,
    "identify": IdentifyAnswer,
    "identify-laws": IdentifyLawsAnswer,
    "identify-sliding": IdentifySlidingAnswer,
    "judge": JudgeAnswer,
    "learn": LearnAnswer,
    "tune": TuneAnswer,
    "limits": LimitsAnswer,
    "worst": WorstAnswer,
    "rare": RareAnswer,
    "parameters": ParametersAnswer,
    "parameters-guides": ParametersGuidesAnswer,
    "jerks": JerksAnswer,
    "compare": CompareAnswer,
    "history": HistoryAnswer,
    "monitor": MonitorAnswer,
    "accept": AcceptAnswer,
    "plan-goal": PlanGoalAnswer,
    "plan-pilot": PlanPilotAnswer,
    "plan-success": PlanSuccessAnswer,
    "plan-machines": PlanMachinesAnswer,
    "plan-halfwidth": PlanHalfwidthAnswer,
    "plan-equivalence": PlanEquivalenceAnswer,
    "sensitivity": SensitivityAnswer,
    "status": StatusAnswer,
}


class Ask(Protocol):
    """Asks the program, and gives the answer of the command."""

    @overload
    def __call__(self, command: Literal["check"], /, *operands: Any, **options: Any) -> CheckAnswer: ...
    @overload
    def __call__(self, command: Literal["summary"], /, *operands: Any, **options: Any) -> SummaryAnswer: ...
    @overload
    def __call__(self, command: Literal["verify"], /, *operands: Any, **options: Any) -> VerifyAnswer: ...
    @overload
    def __call__(self, command: Literal["experiment"], /, *operands: Any, **options: Any) -> ExperimentAnswer: ...
    @overload
    def __call__(self, command: Literal["identify"], /, *operands: Any, **options: Any) -> IdentifyAnswer | IdentifyLawsAnswer | IdentifySlidingAnswer: ...
    @overload
    def __call__(self, command: Literal["judge"], /, *operands: Any, **options: Any) -> JudgeAnswer: ...
    @overload
    def __call__(self, command: Literal["learn"], /, *operands: Any, **options: Any) -> LearnAnswer: ...
    @overload
    def __call__(self, command: Literal["tune"], /, *operands: Any, **options: Any) -> TuneAnswer: ...
    @overload
    def __call__(self, command: Literal["limits"], /, *operands: Any, **options: Any) -> LimitsAnswer: ...
    @overload
    def __call__(self, command: Literal["worst"], /, *operands: Any, **options: Any) -> WorstAnswer: ...
    @overload
    def __call__(self, command: Literal["rare"], /, *operands: Any, **options: Any) -> RareAnswer: ...
    @overload
    def __call__(self, command: Literal["parameters"], /, *operands: Any, **options: Any) -> ParametersAnswer | ParametersGuidesAnswer: ...
    @overload
    def __call__(self, command: Literal["jerks"], /, *operands: Any, **options: Any) -> JerksAnswer: ...
    @overload
    def __call__(self, command: Literal["compare"], /, *operands: Any, **options: Any) -> CompareAnswer: ...
    @overload
    def __call__(self, command: Literal["history"], /, *operands: Any, **options: Any) -> HistoryAnswer: ...
    @overload
    def __call__(self, command: Literal["monitor"], /, *operands: Any, **options: Any) -> MonitorAnswer: ...
    @overload
    def __call__(self, command: Literal["accept"], /, *operands: Any, **options: Any) -> AcceptAnswer: ...
    @overload
    def __call__(self, command: Literal["plan"], /, *operands: Any, **options: Any) -> PlanGoalAnswer | PlanPilotAnswer | PlanSuccessAnswer | PlanMachinesAnswer | PlanHalfwidthAnswer | PlanEquivalenceAnswer: ...
    @overload
    def __call__(self, command: Literal["sensitivity"], /, *operands: Any, **options: Any) -> SensitivityAnswer: ...
    @overload
    def __call__(self, command: Literal["status"], /, *operands: Any, **options: Any) -> StatusAnswer: ...
    @overload
    def __call__(self, command: str, /, *operands: Any, **options: Any) -> Answer: ...
