#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""shearstats against closed forms: conservation, rigid rotation, shear, lattice, column, symmetry."""
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from motions import Contacts, write_motion
from tap import done, ok, run, scratch_paths

at = scratch_paths()
rng = np.random.default_rng(7)


def fields(motion, **settings):
    """The artifact of shearstats, every dataset by its path."""
    words = [w for key, value in settings.items() for w in ("--set", f"{key.replace('__', '.')}={value}")]
    inputs = motion if isinstance(motion, list) else [motion]
    run("shearstats", "-q", *inputs, "-o", at("out"), *words)
    found = {}
    with h5py.File(at("out")) as file:
        file.visititems(lambda name, item: found.update({name: item[()]})
                        if isinstance(item, h5py.Dataset) else None)
    return found


def close(got, wanted, tolerance, title):
    worst = np.max(np.abs(np.asarray(got) - wanted))
    ok(worst <= tolerance, title, f"off by {worst}")


def cloud(n, centre=(0, 0, 0)):
    """Grains anywhere in a ring, with contacts between any neighbours in the list, wet."""
    angle, r, z = rng.uniform(0, 2 * np.pi, n), np.sqrt(rng.uniform(1, 9, n)), rng.uniform(0, 2, n)
    x = np.stack([r * np.cos(angle), r * np.sin(angle), z], 1) + centre
    pair = np.stack([np.arange(n - 1), np.arange(1, n)], 1)
    near = np.linalg.norm(x[pair[:, 1]] - x[pair[:, 0]], axis=1) < 2
    pair = pair[near]
    middle = 0.5 * (x[pair[:, 0]] + x[pair[:, 1]])
    return x, Contacts(pair, rng.normal(size=(len(pair), 3)), middle, rng.normal(size=len(pair)),
                       np.ones(len(pair)), rng.uniform(0, 1, len(pair)))


# ---- conservation --------------------------------------------------------------------------
n = 400
x, contacts = cloud(n)
v, mass = rng.normal(size=(n, 3)), rng.uniform(1, 2, n)
radius = rng.uniform(0.1, 0.2, n)
cloudy = write_motion(at("cloud"), [x], [v], radius, mass, [contacts], lower=(-9,) * 3, upper=(9,) * 3)
branch = x[contacts.pair[:, 1]] - x[contacts.pair[:, 0]]
normal = branch / np.linalg.norm(branch, axis=1)[:, None]
pull = -contacts.pull[:, None] * normal
for smoothing in [0, 0.1, 0.3]:
    for frame in ["cartesian", "cylindrical"]:  # whose branches leave the ring: from the axis on
        room = {} if frame == "cartesian" else {"grid__lower": "[0,0,-2]"}
        f = fields(cloudy, coordinates=frame, smoothing_length=smoothing, grid__spacing=0.21, **room)
        volume, tag = f["grid/volume"], f"{frame}, smoothing length {smoothing}"
        total = lambda name: np.tensordot(volume, f["fields/" + name], 1)
        close(total("density") / mass.sum(), 1, 1e-13, f"{tag}: mass")
        close(total("number_density") / n, 1, 1e-13, f"{tag}: number of grains")
        close(total("volume_fraction") / (4 / 3 * np.pi * (radius ** 3).sum()), 1, 1e-13, f"{tag}: volume")
        close(f["runs/mass_inside"], 1, 1e-13, f"{tag}: all mass is inside")
        if frame == "cartesian":
            close(total("momentum"), mass @ v, 1e-11, f"{tag}: momentum")
            close(total("contact_stress"), np.einsum("ka,kb", contacts.force - pull, branch), 1e-11,
                  f"{tag}: stress of contacts is the sum of force times branch")
            close(total("bridge_stress"), np.einsum("ka,kb", pull, branch), 1e-11,
                  f"{tag}: stress of bridges")
            flux = np.einsum("k,ka,kb", mass, v, v)
            mean = np.einsum("c,ca,cb", volume, f["fields/momentum"], f["fields/velocity"])
            close(total("kinetic_stress") + mean, flux, 1e-10, f"{tag}: flux of momentum")
        else:
            trace = lambda name: np.trace(total(name))
            close(trace("contact_stress"), ((contacts.force - pull) * branch).sum(), 1e-11,
                  f"{tag}: trace of the stress, whatever the directions")
        touching = (contacts.overlap >= 0).sum()
        close(total("contact_density") / touching, 1, 1e-12, f"{tag}: contacts")
        filled = f["fields/contact_density"] > 0
        close(np.trace(f["fields/fabric"], axis1=1, axis2=2)[filled], 1, 1e-11, f"{tag}: trace of the fabric")

# ---- symmetry ------------------------------------------------------------------------------
cylinder = dict(smoothing_length=0.2, grid__lower="[0.3,0,-1]", grid__upper="[4,0,3]")
upright = fields(cloudy, **cylinder)
spin = np.array([[np.cos(0.7), -np.sin(0.7), 0], [np.sin(0.7), np.cos(0.7), 0], [0, 0, 1]])
tilt = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # z becomes x
lean = np.linalg.qr(rng.normal(size=(3, 3)))[0]
lean *= np.linalg.det(lean)


def turned(matrix, shift):
    return write_motion(at("turned"), [x @ matrix.T + shift], [v @ matrix.T], radius, mass,
                        [Contacts(contacts.pair, contacts.force @ matrix.T,
                                  contacts.point @ matrix.T + shift, contacts.overlap,
                                  contacts.volume, contacts.pull)], lower=(-20,) * 3, upper=(20,) * 3)


for title, matrix in [("turned about its axis", spin), ("axis along x", tilt), ("axis anywhere", lean)]:
    shift = np.array([1.5, -2, 3])
    f = fields(turned(matrix, shift), axis__point=f"[{','.join(map(repr, shift.tolist()))}]",
               axis__direction=f"[{','.join(map(repr, matrix[:, 2].tolist()))}]", **cylinder)
    there = upright["fields/density"] > 1e-3 * upright["fields/density"].max()  # not a kernel's end
    worst = max(np.max(np.abs(f[k] - upright[k])[there]) / max(np.max(np.abs(upright[k])), 1e-300)
                for k in upright if k.startswith("fields/") and k[7:] not in ("filled", "flowing")
                and not k.endswith("strain_rate") and not k.endswith("shear_rate"))
    ok(worst < 1e-10, f"a cylinder {title}: same components", worst)
box = dict(coordinates="cartesian", smoothing_length=0.3, grid__lower="[-4,-4,-4]", grid__upper="[4,4,4]",
           grid__spacing=0.5)
straight = fields(cloudy, **box)
f = fields(turned(tilt, np.zeros(3)), **box)
shape = tuple(straight["grid/counts"])
order = [2, 0, 1]  # cells too: x of the turned scene is z of the first
for name in ["density", "contact_stress", "kinetic_stress", "strain_rate", "fabric"]:
    a = straight["fields/" + name].reshape(shape + straight["fields/" + name].shape[1:])
    a = a.transpose(order + list(range(3, a.ndim)))
    if a.ndim == 5:
        a = np.einsum("ia,jb,xyzab->xyzij", tilt, tilt, a)
    close(f["fields/" + name], a.reshape(f["fields/" + name].shape), 1e-10 * np.abs(a).max(),
          f"axes exchanged turn {name}")

# ---- rigid rotation ------------------------------------------------------------------------
omega = 0.3
rotating = write_motion(at("rigid"), [x], [omega * np.stack([-x[:, 1], x[:, 0], 0 * x[:, 2]], 1)],
                        radius, mass)
for smoothing in [0.1, 0.5]:
    f = fields(rotating, smoothing_length=smoothing, grid__spacing=0.2)
    full = f["fields/filled"] > 0
    close(f["fields/angular_velocity"][full], omega, 1e-12, f"rigid rotation: angular velocity, {smoothing}")
    close(f["fields/strain_rate"][full], 0, 1e-11, f"rigid rotation strains nothing, {smoothing}")
    close(f["fields/kinetic_stress"] / f["fields/density"].max(), 0, 1e-13,
          f"rigid rotation has no fluctuations, {smoothing}")

# ---- shear with a given profile ------------------------------------------------------------
m, length, speed = 6000, 2.0, 0.1  # layers of equal mass, a sine along z that repeats
z = (np.arange(m) + 0.5) * length / m
k = 2 * np.pi / length
layer = np.stack([0 * z, 0 * z, z], 1)
sine = write_motion(at("sine"), [layer], [np.stack([speed * np.sin(k * z), 0 * z, 0 * z], 1)], 0.05, 1.0,
                    lower=(-1, -1, 0), upper=(1, 1, length), periodic=(1, 1, 1))
error = []
for smoothing in [0.05, 0.1, 0.2]:
    f = fields(sine, coordinates="cartesian", grid__along='["z"]', grid__spacing=0.02,
               smoothing_length=smoothing)
    at_z = f["grid/centre"][:, 2]
    error.append(np.max(np.abs(f["fields/velocity"][:, 0] / speed - np.sin(k * at_z))))
    close(error[-1], 1 - np.exp(-0.5 * (k * smoothing) ** 2) if smoothing < 0.06 else error[-1],
          0.02 * error[-1] + 1e-4, f"shear: smoothed as by a Gaussian, {smoothing}")
    slope = 0.5 * k * speed * np.exp(-0.5 * (k * smoothing) ** 2) * np.abs(np.cos(k * at_z))
    close(f["fields/shear_rate"], slope, 0.03 * slope.max(), f"shear: rate is half the slope, {smoothing}")
ok(3.6 < error[1] / error[0] < 4.2, "shear: error falls as the square of the smoothing length", error)

# ---- pressurised lattice -------------------------------------------------------------------
d, side, push = 0.5, 4, (3.0, 5.0, 7.0)
index = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)
lattice = (index + 0.5) * d
number = lambda i: (i[:, 0] * side + i[:, 1]) * side + i[:, 2]
pair, force, point = [], [], []
for axis in range(3):
    step = np.eye(3, dtype=int)[axis]
    pair.append(np.stack([number(index), number((index + step) % side)], 1))
    force.append(np.tile(push[axis] * step, (len(index), 1)))
    point.append(lattice + 0.5 * d * step)
held = Contacts(np.concatenate(pair), np.concatenate(force), np.concatenate(point))
squeezed = write_motion(at("lattice"), [lattice], [0 * lattice], d / 2, 1.0, [held], lower=(0, 0, 0),
                        upper=(d * side,) * 3, periodic=(1, 1, 1))
stress = np.diag(push) / d ** 2
for smoothing in [0.5, 1, 2]:
    f = fields(squeezed, coordinates="cartesian", smoothing_length=smoothing * d, grid__spacing=d / 4)
    mean = np.einsum("c,cab", f["grid/volume"], f["fields/contact_stress"]) / f["grid/volume"].sum()
    close(mean, stress, 1e-11, f"lattice: mean stress is force over area, {smoothing} d")
    ripple = np.max(np.abs(f["fields/contact_stress"] - stress)) / np.max(stress)
    u = 6 * np.pi * smoothing  # waves of the lattice across the branch, as the kernel weakens them
    weakened = 105 / u ** 3 * abs((15 / u ** 2 - 1) / u)
    ok(ripple < 4.2 * weakened + 1e-6, f"lattice: as uniform as the kernel makes it, {smoothing} d",
       f"{ripple} of {weakened}")
    close(f["fields/coordination"], 6, 1e-12, f"lattice: six neighbours, {smoothing} d")
    close(f["fields/pressure"], 15 / 3 / d ** 2, 0.06 * 20, f"lattice: pressure, {smoothing} d")
f = fields(squeezed, coordinates="cartesian", smoothing_length=d, grid__spacing=d / 4)
wanted = np.diag([1 / 3] * 3)
close(np.einsum("c,cab", f["fields/contact_density"], f["fields/fabric"]) / f["fields/contact_density"].sum(),
      wanted, 1e-12, "lattice: isotropic fabric")

# ---- side walls ----------------------------------------------------------------------------
# Pressed grains touch a wall a little beyond the side of the box. Along an axis that is one
# interval their forces count as they do where it is divided.
m = 20
row = np.stack([rng.uniform(0, 2, m), rng.uniform(0, 1, m), rng.uniform(0, 2, m)], 1)
wall = rng.integers(0, 4, m)  # x and y, lower and upper
inwards = np.zeros((m, 3))
inwards[np.arange(m), wall // 2] = 1 - 2 * (wall % 2)
row[np.arange(m), wall // 2] = np.choose(wall, [0.048, 1.952, 0.048, 0.952])
point = row - 0.049 * inwards  # a radius less half the overlap away
push = rng.normal(size=(m, 3))
boxed = write_motion(at("boxed"), [row], [0 * row], 0.05, 1.0,
                     [Contacts(np.stack([np.arange(m), -1 - wall], 1), push, point)],
                     lower=(0, 0, 0), upper=(2, 1, 2), walls=[(0, 0, 0)] * 4)
for along in '["x","y","z"]', '["z"]', '["x"]':
    for room in {}, {"grid__lower": "[0,0,-1]", "grid__upper": "[2,1,3]"}:
        if room and along != '["z"]':
            continue
        f = fields(boxed, coordinates="cartesian", grid__along=along, smoothing_length=0, grid__spacing=0.3, **room)
        close(np.tensordot(f["grid/volume"], f["fields/traction"], 1), -push.sum(axis=0), 1e-12,
              f"side walls, cells along {along}{', told' if room else ''}: the traction is that of all walls")

# ---- column under gravity ------------------------------------------------------------------
m, d, g = 12, 0.1, 9.81
column = np.stack([np.full(m, 0.5), np.full(m, 0.5), (np.arange(m) + 0.5) * d], 1)
pair = [(0, -1)] + [(i, i + 1) for i in range(m - 1)]
force = [(0, 0, -m * g)] + [(0, 0, (m - 1 - i) * g) for i in range(m - 1)]
point = [(0.5, 0.5, i * d) for i in range(m)]
stack = write_motion(at("column"), [column], [0 * column], d / 2, 1.0, [Contacts(pair, force, point)],
                     lower=(0, 0, 0), upper=(1, 1, 2), walls=[(0, 0, 0)])
imbalance = []
for cells in [4, 8, 16]:
    h = d / cells
    f = fields(stack, coordinates="cartesian", grid__along='["z"]', smoothing_length=d, grid__spacing=h,
               grid__lower="[0,0,-0.5]", grid__upper="[1,1,2]")
    s = f["fields/contact_stress"][:, 2, 2]
    lost = -(s[2:] - s[:-2]) / (2 * h) + f["fields/traction"][1:-1, 2] - g * f["fields/density"][1:-1]
    imbalance.append(np.max(np.abs(lost)) / (g * f["fields/density"].max()))
    close(f["grid/volume"] @ f["fields/traction"][:, 2], m * g, 1e-10, "column: the floor carries the weight")
ok(imbalance[2] < 3e-3, "column: stress, floor and weight balance in each cell", imbalance)
ok(imbalance[0] / imbalance[1] > 3.3, "column: to the square of the spacing", imbalance)
middle = np.argmin(np.abs(f["grid/centre"][:, 2] - 0.55))
close(f["fields/contact_stress"][middle, 2, 2] / (g * 6.5), 1, 0.02, "column: weight above, over area")

# ---- driven grains are boundary ------------------------------------------------------------
pair = [(0, 1), (1, 2)]
line = np.array([[0, 0, 0], [1, 0, 0], [2.0, 0, 0]])
three = write_motion(at("driven"), [line], [line], 0.5, 1.0,
                     [Contacts(pair, [(2, 0, 0), (2, 0, 0)], [(0.5, 0, 0), (1.5, 0, 0)])],
                     driven=[1, 0, 0], lower=(-5,) * 3, upper=(5,) * 3)
f = fields(three, coordinates="cartesian", smoothing_length=0.5)
close(f["grid/volume"] @ f["fields/density"], 2, 1e-13, "driven grains have no mass here")
close(np.tensordot(f["grid/volume"], f["fields/contact_stress"], 1)[0, 0], 2 * 0.5 + 2 * 1, 1e-13,
      "a contact with one reaches from the grain to the contact")
close(np.tensordot(f["grid/volume"], f["fields/traction"], 1), [2, 0, 0], 1e-13, "and gives the traction")

# ---- any number of threads -----------------------------------------------------------------
many = write_motion(at("many"), [x] * 7, [v + s for s in range(7)], radius, mass, [contacts] * 7)
outcome = []
for threads in [1, 2, 3]:
    run("shearstats", "-q", "--threads", threads, many, "-o", at(f"threads{threads}"))
    outcome.append(open(at(f"threads{threads}"), "rb").read())
ok(outcome[0] == outcome[1] == outcome[2], "the same bytes with 1, 2 and 3 threads")
done()
