function ample(folder, benchmark, cells)
%AMPLE  Benchmarks in AMPLE 1.1: a column, a slope of von Mises soil, a footing.
%
%   octave --eval "ample('/path/to/AMPLE', 'column', 64)"
%   octave --eval "ample('/path/to/AMPLE', 'von_mises_slope')"
%   octave --eval "ample('/path/to/AMPLE', 'footing')"
%
% The folder is that of a copy of AMPLE (https://github.com/wmcoombs/AMPLE), whose functions elemMPinfo, detExtForce,
% detFDoFs, linSolve, detMPs and updateMPs are called; nothing of it is changed. Geometry, parameters, spacing and points
% are those of the case files of igimp with these names. AMPLE has elastic and von Mises soil: no slope of Mohr-Coulomb
% soil, and the footing stands in von Mises soil of the same strength in plane strain. It has no measure against locking.
%
% Prints one line of JSON, as kratos.py does.
addpath(fullfile(folder, 'constitutive'), fullfile(folder, 'functions'), fullfile(folder, 'setup'));
if nargin < 3
  cells = 64;
end
switch benchmark
  case 'column'
    h = 50/cells;
    mesh = grid(1, cells + 1, h, @(x, y) [true, y < 1e-9]);
    points = body(mesh, 1, cells, 2, @(x, y) true(size(x)), 1, [1e4, 0], 80);
    [steps, gravity] = deal(40, 10);
  case 'von_mises_slope'
    mesh = grid(80, 31, 0.5, @(x, y) [x < 1e-9 || x > 40 - 1e-9 || y < 1e-9, y < 1e-9]);
    inside = @(x, y) y < 5 | x < 30 - y;
    points = body(mesh, 80, 30, 2, inside, 2, [1e6, 0.49, sqrt(2)*45e3], 20e3/9.81);
    [steps, gravity] = deal(10, 9.81);
  case 'footing'
    [steps, gravity] = deal(4, 0);
    under = @(x, y) x < 0.5 && abs(y - 5.04) < 1e-9;
    held = @(x, y) [x < 1e-9 || x > 5.04 - 1e-9 || under(x, y), y < 1e-9 || under(x, y)];
    mesh = grid(48, 58, 0.105, held);
    points = body(mesh, 48, 48, 3, @(x, y) true(size(x)), 2, [1e5, 0.495, sqrt(2)*1e3], 1);
    base = find(mesh.coord(:,1) < 0.5 & abs(mesh.coord(:,2) - 5.04) < 1e-9);
    [~, rows] = ismember(2*base, mesh.bc(:,1));
    mesh.bc(rows, 2) = -0.0125;
  otherwise
    error('AMPLE has no soil for %s', benchmark);
end
start = vertcat(points.mpC);
clock = tic;
[points, done, reaction] = march(mesh, points, steps, gravity);
seconds = toc(clock);
switch benchmark
  case 'column'
    stress = [points.sig];
    exact = -800*(50 - start(:,2).');
    found = sprintf('"stress error": %.6e', mean(abs(stress(2,:) - exact))/(800*50));
  case 'von_mises_slope'
    found = sprintf('"largest displacement [m]": %.6f', max(sqrt(sum((vertcat(points.mpC) - start).^2, 2))));
  case 'footing'
    found = sprintf('"N at %.4f B": %.4f', done*0.0125, 2*abs(sum(reaction(2*base)))/1e3);
end
fprintf('{"benchmark": "%s", "seconds": %.3f, "steps": %d, "of": %d, "found": {%s}}\n', ...
        benchmark, seconds, done, steps, found);
end

function mesh = grid(columns, rows, h, held)
%GRID  A grid of squares; held says which components of a node are held.
[mesh.etpl, mesh.coord] = formCoord2D(columns, rows, columns*h, rows*h);
mesh.h = [h, h];
mesh.bc = zeros(0, 2);
for node = 1:size(mesh.coord, 1)
  is_held = held(mesh.coord(node,1), mesh.coord(node,2));
  for component = find(is_held)
    mesh.bc(end + 1, :) = [2*(node - 1) + component, 0];
  end
end
end

function points = body(mesh, columns, rows, per_side, inside, law, constants, density)
%BODY  Points of a body with domains (GIMP), a square of them in every cell.
d = mesh.h(1)/per_side;
[x, y] = meshgrid(((1:columns*per_side) - 0.5)*d, ((1:rows*per_side) - 0.5)*d);
places = [x(:), y(:)];
places = places(inside(places(:,1), places(:,2)), :);
none = struct('mpType', 2, 'cmType', law, 'mpC', [0 0], 'vp', d^2, 'vp0', d^2, 'mpM', density*d^2, ...
              'nIN', [], 'eIN', 0, 'nSMe', 0, 'Svp', [], 'dSvp', [], 'Fn', eye(3), 'F', eye(3), ...
              'sig', zeros(6,1), 'epsEn', zeros(6,1), 'epsE', zeros(6,1), 'mCst', constants, ...
              'fp', zeros(2,1), 'u', zeros(2,1), 'lp', [d d]/2, 'lp0', [d d]/2);
points = repmat(none, 1, size(places, 1));
for k = 1:size(places, 1)
  points(k).mpC = places(k,:);
end
end

function [points, done, reaction] = march(mesh, points, steps, gravity)
%MARCH  Steps to equilibrium; it ends at the first that has none within 25 corrections.
nodes = size(mesh.coord, 1);
done = 0;
reaction = zeros(2*nodes, 1);
for step = 1:steps
  [mesh, points] = elemMPinfo(mesh, points);
  load = detExtForce(nodes, 2, gravity, points)*step/steps;
  free = detFDoFs(mesh);
  [u, own, K, out] = deal(zeros(2*nodes, 1), zeros(2*nodes, 1), 0, load);
  for correction = 0:25
    [du, more] = linSolve(mesh.bc, K, out, correction, free);
    [u, own] = deal(u + du, own + more);
    [inner, K, points] = detMPs(u, points);
    out = load - inner + own;
    wrong = norm(out)/norm(load + own + eps);
    if correction > 0 && wrong < 1e-9
      break
    end
  end
  if ~(wrong < 1e-9)
    return
  end
  points = updateMPs(u, points);
  [done, reaction] = deal(step, own);
end
end
