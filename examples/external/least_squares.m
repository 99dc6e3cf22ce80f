% Least squares of T r' + r = K (delta + delta_r) integrated twice, which leaves no derivative:
% psi = -1/T int(psi) + K/T iint(delta) + K delta_r/T t^2/2 + c1 t + c0. White noise n of the heading leaves
% n + int(n)/T: a second fit makes it white again with the T of the first, so that its standard deviations hold.
% Octave 7 or later: octave-cli --quiet --norc least_squares.m TRIALS > TRIALS/least_squares.csv
1;

function s = integral_of(t, y)
  s = [zeros(1, columns(y)); cumsum(diff(t) .* (y(2:end, :) + y(1:end-1, :)) / 2)];
end

function answer = estimate(t, heading, rudder)
  rows = [t, heading, rudder];
  rows = rows(all(isfinite(rows), 2), :);
  if size(rows, 1) < 10 || max(rows(:, 3)) - min(rows(:, 3)) < 1e-4
    error("too few rows or the rudder does not move");
  end
  t = rows(:, 1);
  psi = rows(:, 2);
  y = [integral_of(t, psi), integral_of(t, integral_of(t, rows(:, 3))), t.^2 / 2, t, ones(size(t)), psi];
  a = (y(:, 1:5) \ y(:, 6))(1);  % -1/T
  y += a * exp(a * t) .* integral_of(t, exp(-a * t) .* y);
  x = y(:, 1:5);
  if !all(isfinite(y(:))) || rank(x) < 5
    error("the record does not determine K and T");
  end
  theta = x \ y(:, 6);
  [a, b, c] = deal(theta(1), theta(2), theta(3));
  slope = [b / a^2, -1 / a, 0; 1 / a^2, 0, 0; 0, -c / b^2, 1 / b];  % of K, T and delta_r
  covariance = slope * inv(x' * x)(1:3, 1:3) * slope' * sumsq(y(:, 6) - x * theta) / (numel(t) - 5);
  sd = sqrt(diag(covariance));
  if !all(isfinite([b / a, 1 / a, c / b, sd']))
    error("the record does not determine K and T");
  end
  answer = [-b / a, -1 / a, rad2deg(c / b), sd(1), sd(2), rad2deg(sd(3))];
end

% The answers to the records of a folder that `study simulate` wrote, on standard output.
folder = argv(){end};
printf("record,K_per_s,T_s,delta_r_deg,K_sd_per_s,T_sd_s,delta_r_sd_deg,failed\n");
trials = fopen(fullfile(folder, "trials.csv"));
fgetl(trials);
while ischar(line = fgetl(trials))
  name = strtok(line, ",");
  file = fopen(fullfile(folder, name));
  head = strsplit(fgetl(file), ",");
  fclose(file);
  rows = dlmread(fullfile(folder, name), ",", 1, 0, "emptyvalue", NaN);
  column = @(key) rows(:, strcmp(head, key));
  try
    answer = estimate(column("t_s"), deg2rad(column("heading_deg")), deg2rad(column("rudder_deg")));
    printf("%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,\n", name, answer);
  catch problem
    printf("%s,,,,,,,%s\n", name, problem.message);
  end
end
