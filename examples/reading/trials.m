% The table of trials.py. MATLAB shows dimensions in the reverse order: outcomes are [move, trial].
file = 'study.h5';
labels   = h5read(file, '/point/label');
low      = h5read(file, '/point/success_rate_low');
high     = h5read(file, '/point/success_rate_high');
point    = h5read(file, '/trial/point');
worst    = max(h5read(file, '/outcome/outcome'), [], 1)';       % of each trial; 0 is zero_count
settling = h5read(file, '/outcome/arrival_time')';             % s, [trial, move]; NaN where a move never arrived
jerks    = sum(double(h5read(file, '/outcome/jerk_count')), 1)';

for p = 0:numel(labels) - 1
    mine = point == p;
    n = sum(mine);  k = sum(worst(mine) == 0);
    times = sort(reshape(settling(mine, :), [], 1));            % NaN comes last: later than any time
    median_and_p95 = times(ceil([0.5 0.95] * numel(times)))';
    fprintf('%s\t%d\t%g\t%g\t%g\t%g\t%g\t%g\n', labels(p + 1), n, k / n, low(p + 1), high(p + 1), median_and_p95, mean(jerks(mine)));
end
