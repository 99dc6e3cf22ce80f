% Least squares of T r' + r = K (delta + delta_r) integrated twice, which leaves no derivative:
% psi = -1/T int(psi) + K/T iint(delta) + K delta_r/T t^2/2 + c1 t + c0. White noise n of the heading leaves
% n + int(n)/T: a second fit makes it white again with the T of the first, so that its standard deviations hold.
% Octave 7 or later: octave-cli --quiet --norc least_squares.m
1;

function s = integral_of(t, y)
  s = [zeros(1, columns(y)); cumsum(diff(t) .* (y(2:end, :) + y(1:end-1, :)) / 2)];
end

function answer = estimate(record)
  rows = [record.t_s(:), record.heading_rad(:), record.rudder_rad(:)];  % null has become NaN
  rows = rows(all(isfinite(rows), 2), :);
  if size(rows, 1) < 10 || max(rows(:, 3)) - min(rows(:, 3)) < 1e-4
    error("too few rows, or the rudder does not move");
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
  answer = struct("K_per_s", -b / a, "T_s", -1 / a, "delta_r_rad", c / b);
  answer.sd = struct("K_per_s", sd(1), "T_s", sd(2), "delta_r_rad", sd(3));
end

% fgetl would wait for the first character of the next line before it gives this one, and that line never comes.
while !isempty(line = fscanf(stdin, "%[^\n]", "C"))
  fread(stdin, 1);
  record = jsondecode(line);
  try
    answer = estimate(record);
  catch problem
    answer = struct("failed", problem.message);
  end
  answer.trial = record.trial;
  printf("%s\n", jsonencode(answer));
  fflush(stdout);
end
