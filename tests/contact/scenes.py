"""Small scenes in which surfaces try to get through each other, in frames of one substep."""

import math
import random
import re

SUBSTEP = 1.0 / 600.0


def head(frames, contact="thickness = 0.004", gravity="[0.0, -9.81, 0.0]", iterations=10,
         step=SUBSTEP, extra=""):
    return f"""
[scene]
frames = {frames}
dt = {step!r}
substeps = 1
gravity = {gravity}
{extra}
[solver]
method = "vbd"
iterations = {iterations}
[contact]
{contact}
"""


def cloth(name, shape, place="", density=0.2, stiffness=500.0, bend=1e-5):
    return f"""
[[cloth]]
name = "{name}"
{shape}
density = {density}
stretch = {{ stiffness = {stiffness} }}
bend = {{ stiffness = {bend} }}
{place}
"""


def grid(width, depth, across, along):
    return f"grid = {{ size = [{width}, {depth}], resolution = [{across}, {along}] }}"


def block(name, size, resolution, place="", density=500.0, young=5e4):
    return f"""
[[solid]]
name = "{name}"
grid = {{ size = {size}, resolution = {resolution} }}
density = {density}
young = {young}
poisson = 0.3
{place}
"""


def jittered(text, seed):
    """The scene with its bodies up to 1 mm aside, gaps up to 0.4 mm other, and gravity another by
    up to 1 % and 0.1 m/s^2: what must not matter to whether anything passes."""
    chance = random.Random(seed)

    def moved(match, ranges):
        values = [float(value) for value in match[2].split(",")]
        near = [value + chance.uniform(-by(value), by(value)) for value, by in zip(values, ranges)]
        return f"{match[1]}[{', '.join(map(repr, near))}]"

    places = [lambda _: 0.001, lambda _: 0.0002, lambda _: 0.001]
    pull = [lambda value: 0.1 + 0.01 * abs(value)] * 3
    text = re.sub(r"^(translate = )\[([^\]]*)\]", lambda m: moved(m, places), text, flags=re.M)
    return re.sub(r"^(gravity = )\[([^\]]*)\]", lambda m: moved(m, pull), text, flags=re.M)


HELD = "pins = { box = [[-9, -9, -9], [9, 9, 9]] }"


def carried(motion):
    return f"pins = {{ box = [[-9, -9, -9], [9, 9, 9]], motion = {{ {motion} }} }}"


def stack(count, side, frames, iterations=10):
    sheets = [cloth("floor", grid(0.3, 0.3, side + 1, side + 1), HELD)]
    for i in range(count):
        place = f"rotate = [0, 1, 0, {7 * i}]\ntranslate = [0, {0.005 * (i + 1)}, 0]"
        sheets.append(cloth(f"sheet{i}", grid(0.2, 0.2, side, side), place))
    return head(frames, iterations=iterations) + "".join(sheets)


def twist(frames=300):
    """By 4 pi, from both ends."""
    turn = 360.0 / (frames * SUBSTEP)
    pins = "".join(
        f"[[cloth.pins]]\nedges = [\"{edge}\"]\nmotion = {{ angular_velocity = {sign * turn!r}, "
        f"axis = [1, 0, 0], velocity = [{-0.1 * sign!r}, 0, 0] }}\n"
        for edge, sign in (("x-", -1), ("x+", 1)))
    return head(frames, gravity="[0, 0, 0]") + cloth("ribbon", grid(0.5, 0.15, 34, 11), pins)


def needle(frames=120):
    sheets = "".join(cloth(f"sheet{i}", grid(0.3, 0.3, 12, 12),
                           f"translate = [0, {-0.01 * i}, 0]\npins = {{ edges = [\"x-\", \"x+\"] }}")
                     for i in range(3))
    return head(frames) + sheets + block("needle", "[0.01, 0.1, 0.01]", "[2, 6, 2]",
                                         "translate = [0.003, 0.06, 0.002]\n"
                                         + carried("velocity = [0, -0.5, 0]"))


def fast_sheets(frames=40):
    """10 m/s within the first substep, from 5 mm above."""
    extra = f"gravity_keyframes = [[0, 0, -6000, 0], [{SUBSTEP!r}, 0, -6000, 0], " \
            f"[{1.01 * SUBSTEP!r}, 0, -9.81, 0]]"
    return (head(frames, extra=extra)
            + cloth("low", grid(0.3, 0.3, 13, 13), "pins = { edges = [\"x-\", \"x+\"] }")
            + cloth("high", grid(0.2, 0.2, 12, 12), "translate = [0.01, 0.005, 0.003]"))


def pile(name, count, place, sides=8, gap=0.005):
    """Free sheets over each other."""
    x, y, z = place
    return "".join(cloth(f"{name}{i}", grid(0.15, 0.15, sides, sides),
                         f"rotate = [0, 1, 0, {9 * i}]\ntranslate = [{x}, {y + gap * i}, {z}]")
                   for i in range(count))


def landing(frames=70):
    """A pile falls onto a floor, and another one onto it, at 6 and 7 m/s."""
    push = 3.0 / (5 * SUBSTEP)
    extra = f"gravity_keyframes = [[0, 0, {-push!r}, 0], [{4.5 * SUBSTEP!r}, 0, {-push!r}, 0], " \
            f"[{5.5 * SUBSTEP!r}, 0, -9.81, 0]]"
    return (head(frames, extra=extra) + cloth("floor", grid(0.3, 0.3, 13, 13), HELD)
            + pile("low", 4, (0, 0.1, 0)) + pile("high", 3, (0.02, 0.25, 0.01)))


def fold(frames=300):
    """An edge is laid onto the opposite one, and pressed down."""
    end = frames * SUBSTEP
    motion = (f"[[cloth.pins]]\nedges = [\"x-\"]\n[[cloth.pins]]\nedges = [\"x+\"]\n"
              f"[cloth.pins.motion]\naxis = [0, 0, 1]\ncenter = [0, 0.01, 0]\nkeyframes = ["
              f"{{ time = 0 }}, {{ time = {0.7 * end!r}, rotate = 176 }}, "
              f"{{ time = {end!r}, rotate = 176, translate = [0, -0.01, 0] }}]\n")
    return head(frames) + cloth("sheet", grid(0.3, 0.15, 24, 12), motion)


def pressed_blocks(frames=200):
    """Two blocks, between plates that come together to half of the height."""
    speed = 0.2 / (frames * SUBSTEP)
    low = block("low", "[0.2, 0.195, 0.2]", "[5, 5, 5]", "translate = [0, 0.1, 0]\n"
                "pins = { faces = [\"y-\"] }")
    high = block("high", "[0.18, 0.195, 0.18]", "[5, 5, 5]", "translate = [0.005, 0.3, 0.003]\n"
                 f"pins = {{ faces = [\"y+\"], motion = {{ velocity = [0, {-speed!r}, 0] }} }}")
    return head(frames) + low + high


def knife(frames=120):
    """An edge comes down on a vertex."""
    return (head(frames)
            + cloth("sheet", grid(0.3, 0.3, 13, 13), "pins = { edges = [\"x-\", \"x+\"] }")
            + cloth("knife", grid(0.1, 0.2, 2, 3), "rotate = [0, 0, 1, 90]\n"
                    "translate = [0, 0.06, 0]\n" + carried("velocity = [0, -0.4, 0]")))


BAG = (13, 17)  # vertices across and along


def bag(frames=300):
    """Two panels, sewn on three sides within 0.1 s; three blocks fall between them, and have to
    stay there."""
    panels = "".join(
        cloth(name, grid(0.24, 0.32, *BAG), f"rotate = [1, 0, 0, 90]\ntranslate = [0, 0, {z}]\n{pins}")
        for name, z, pins in (("front", 0.03, "pins = { corners = [\"x-z-\", \"x+z-\"] }"),
                              ("back", -0.03, "")))
    sides = "edges = [\"x-\", \"z+\", \"x+\"]"
    seam = f"""
[[seam]]
a = {{ cloth = "front", {sides} }}
b = {{ cloth = "back", {sides} }}
stiffness = 500.0
time = 0.1
"""
    blocks = "".join(block(f"block{i}", "[0.03, 0.03, 0.03]", "[3, 3, 3]",
                           f"translate = [{0.06 * (i - 1)}, {0.03 * i - 0.02}, 0.001]",
                           density=300.0) for i in range(3))
    return head(frames, iterations=20) + panels + seam + blocks


def sewn_in_bag():
    """Pairs of vertices, in the order of the scene's."""
    across, along = BAG
    sewn = [v for v in range(across * along)
            if v % across in (0, across - 1) or v // across == along - 1]
    return {(v, v + across * along) for v in sewn}


def sphere_mesh(radius=0.5, levels=3):
    """An icosahedron, refined: 42, 162, 642 vertices."""
    t = (1.0 + math.sqrt(5.0)) / 2.0
    points = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t),
              (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(tuple((p + q) / 2.0 for p, q in zip(points[a], points[b])))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    lines = []
    for p in points:
        size = math.sqrt(sum(x * x for x in p)) / radius
        lines.append("v " + " ".join(f"{x / size:.7g}" for x in p))
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    return "\n".join(lines) + "\n"


def hit_sphere(speed, way=1.5):
    """A ball of cloth of 1 m (sphere.obj) is hit by a box that nothing stops."""
    step = min(SUBSTEP, 0.1 / speed)
    frames = math.ceil(way / (speed * step))
    return (head(frames, "thickness = 0.01", "[0, 0, 0]", step=step)
            + cloth("ball", "mesh = \"sphere.obj\"")
            + block("bat", "[0.1, 0.4, 0.4]", "[3, 5, 5]", "translate = [-0.6, 0.05, 0.02]\n"
                    + carried(f"velocity = [{speed}, 0, 0]")))


def slit_mesh(cells=20, cell=0.02, gap=0.008):
    """A square with a slit from its middle to one side, open by a gap."""
    numbers, points, faces = {}, [], []

    def vertex(x, y, cell_x):
        side = 2 * x == cells and 2 * y > cells and 2 * cell_x >= cells
        if (x, y, side) not in numbers:
            numbers[x, y, side] = len(points) + 1
            points.append(f"v {cell * x + gap * side:.7g} 0 {cell * y:.7g}")
        return numbers[x, y, side]

    for y in range(cells):
        for x in range(cells):
            a, b, c, d = (vertex(x + i, y + j, x) for j in (0, 1) for i in (0, 1))
            faces += [f"f {a} {c} {b}", f"f {b} {c} {d}"]
    return "\n".join(points + faces) + "\n"


def slit(frames=300):
    """One side of a slit (slit.obj) is carried over the other one, and pressed down on it: both are
    flat, and patches along the slit have vertices of both."""
    over = [(0.0, (0, 0, 0)), (0.1, (0, 0.025, 0)), (0.25, (0.05, 0.025, 0)), (0.5, (0.05, -0.1, 0))]
    keys = ", ".join(f"{{ time = {time}, translate = {list(way)} }}" for time, way in over)
    pins = "".join(f"[[cloth.pins]]\nbox = {box}\n{motion}\n" for box, motion in (
        ([[-1, -1, -1], [1, 1, 0.01]], ""),
        ([[0.1, -1, 0.39], [0.202, 1, 1]], f"motion.keyframes = [{keys}]"),
        ([[0.3, -1, 0.39], [1, 1, 1]], "")))
    return (head(frames, gravity="[0, -0.1, 0]")
            + cloth("flaps", "mesh = \"slit.obj\"", "translate = [0, 0, 0]\ndamping = 1.0\n" + pins))


LED_CORNERS = ((-1, -1), (1, -1), (1, 1))


def led_about(seed, frames=200):
    """A sheet whose corners are led to random places and turned there, through whatever is in the
    way: more than cloth can always give way to. Below it another one that is held at an edge."""
    chance = random.Random(seed)
    pins = ""
    for x, z in LED_CORNERS:
        low, high = ([0.2 * x - 0.03, -1, 0.2 * z - 0.03], [0.2 * x + 0.03, 1, 0.2 * z + 0.03])
        keys = "{ time = 0.0 }"
        for quarter in range(1, 5):
            way = [round(chance.uniform(-0.12, 0.12), 4) for _ in range(3)]
            keys += (f", {{ time = {frames * SUBSTEP * quarter / 4:.6g}, translate = {way}, "
                     f"rotate = {chance.uniform(-150, 150):.4g} }}")
        pins += (f"[[cloth.pins]]\nbox = [{low}, {high}]\nmotion = {{ center = [{0.2 * x}, 0, "
                 f"{0.2 * z}], axis = [{x}, 0.5, {z}], keyframes = [{keys}] }}\n")
    return (head(frames, "thickness = 0.005", iterations=chance.choice([3, 6, 10]))
            + cloth("led", grid(0.4, 0.4, 17, 17), "translate = [0, 0, 0]\ndamping = 1.0\n" + pins,
                    stiffness=chance.choice([50.0, 500.0]))
            + cloth("below", grid(0.4, 0.4, 12, 12),
                    "translate = [0, -0.03, 0]\npins = { edges = [\"x-\"] }"))


def held_in_led_about(start):
    """Which vertices are, by where they start."""
    led = {v for v, (x, y, z) in enumerate(start) if y > -0.01 and
           any(max(abs(x - 0.2 * cx), abs(z - 0.2 * cz)) < 0.0301 for cx, cz in LED_CORNERS)}
    return led | {v for v, (x, y, _) in enumerate(start) if y < -0.02 and x < -0.199}


SHORT = {
    "stack10": stack(10, 9, 60),
    "twist": twist(200),
    "needle": needle(),
    "fast_sheets": fast_sheets(),
    "landing": landing(),
    "fold": fold(200),
    "pressed_blocks": pressed_blocks(100),
    "knife": knife(),
    "sphere5": hit_sphere(5.0),
    "slit": slit(),
}

# For the other solvers: through each other from the first substep on, pressed together for long,
# folded, piled up. They share all that comes before and behind the iterations. (What is led into
# cloth takes more of xpbd than this; docs/contact.md.)
OTHER_SOLVERS = {
    "sosd": ["fast_sheets", "needle", "pressed_blocks"],
    "jpgd": ["fast_sheets", "needle", "pressed_blocks", "knife"],
    "xpbd": ["fast_sheets", "pressed_blocks", "fold", "stack10", "knife", "slit", "sphere5", "twist"],
    "newton": ["fast_sheets", "needle", "pressed_blocks", "knife"],
}

# What is led further in a substep than others can give way.
TOO_FAST = {
    "sphere20": hit_sphere(20.0),
    "sphere100": hit_sphere(100.0),
}

# What is sewn together lies upon each other: the oracle has to be told.
SEWN_SOLVERS = ["vbd", "sosd", "jpgd", "xpbd"]

# Takes minutes.
LONG = {
    "stack10": stack(10, 16, 300),
    "stack50": stack(50, 12, 300),
    "solved_stack50": stack(50, 12, 300, iterations=20),
    "twist": twist(600),
    "fold": fold(600),
    "pressed_blocks": pressed_blocks(400),
}
