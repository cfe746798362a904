"""The body of an emulated Create: wheels, gyro, switches and battery, with the sensor values that result."""
from __future__ import annotations

from math import degrees, floor, trunc
from typing import NamedTuple

from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.protocol import CLIFFS, NOTHING_RECEIVED, UPDATE_PERIOD, WHEEL_DROPS, Model
from rbx1_nav.simulation.simulated_base import make_wheels_and_gyro


class BodyErrors(NamedTuple):
    """True errors of a robot, as factors."""

    gyro_sensitivity: float = 1.0   # gyro signal relative to its nominal value
    wheel_travel: float = 1.0       # travel counted by the encoders relative to the true wheel travel
    wheel_base: float = 1.0         # true wheel separation relative to its nominal value


FINE = 1e6              # ticks per meter of the simulated wheels: practically no rounding, since this file counts
ADC_ZERO = 512          # gyro signal at rest, in the range 0 to 1023
CAPACITY = 3000         # mAh
EMPTY, FULL = 13.0, 16.5    # V
CHARGING, RESTING, MOVING = 1500, -300, -1000     # mA: current of the battery
FLOOR, NO_FLOOR = 1500, 20  # signals of a cliff sensor
CONTACT = 0.02          # m that a robot on its dock can move before it loses contact
PULL_UPS = 15           # weak pull-ups on the digital inputs of a Create


class Tally:
    """A sum that is read in whole units. The remainder is kept for the next reading."""

    def __init__(self) -> None:
        self.total = 0.0
        self._read = 0.0

    @property
    def pending(self) -> int:
        """The value that take() will return."""
        return max(-32768, min(32767, floor(self.total + 0.5) - round(self._read)))

    def take(self) -> int:
        """Return the whole units since the last call, limited to 16 bits."""
        value, self._read = self.pending, floor(self.total + 0.5)
        return value


class DroppingTally(Tally):
    """A sum whose readings each start at 0, so that the remainder is lost."""

    @property
    def pending(self) -> int:
        return max(-32768, min(32767, trunc(self.total - self._read)))

    def take(self) -> int:
        value, self._read = self.pending, self.total
        return value


class Body:
    """The robot without its electronics. All times are in ns."""

    def __init__(self, model: Model, surface: Surface | None = None, seed: int = 0, errors: BodyErrors = BodyErrors(),
                 gyro_range: float = 150.0, drops_fractions: bool = False) -> None:
        """surface, seed: see simulated_base.make_base(); gyro_range: degrees/s; drops_fractions: whether each reading
        of the angle starts at 0 and loses the fraction of a degree, as on some Creates (libcreate issue 22,
        create_robot issue 28)."""
        self.model = model
        self.errors = errors
        self.gyro_range = gyro_range
        self.drops_fractions = drops_fractions
        self.gyro_stuck = -1                # 0 to 1023: fixed value of the analog input; negative: the gyro works
        self.wheels, self.gyro = make_wheels_and_gyro(
            model.wheel_separation * errors.wheel_base, surface._replace(ticks_meter=FINE) if surface else None, seed,
            UPDATE_PERIOD)
        self.drive(0, 0)
        self.charging_fault = False
        self.charger = False                # whether the cable of the charger is plugged in
        self.switches = self.cliffs = self.buttons = 0      # bits of packet 7, of CLIFFS, and of packet 18
        self.infrared = 0 if 52 in model.packets else NOTHING_RECEIVED  # character that is received
        self._dock: float | None = None     # m, where the robot touches its dock, on its odometer
        self._odometer = 0.0
        self.charge: float = CAPACITY       # mAh; more than CAPACITY if the robot misjudges its battery
        self.temperature = 25               # degrees C, of the battery
        self.voltage = 0                    # mV; 0: it follows the charge
        self.reset_counters()

    def reset_counters(self) -> None:
        """Reset all counters of the robot to 0."""
        self._counted_left = self._counted_right = 0.0  # m
        self.distance = Tally()     # mm
        self.angle = DroppingTally() if self.drops_fractions else Tally()    # degrees
        self.values: dict[str, int] = dict.fromkeys((packet.name for packet in self.model.packets.values()), 0)

    def drive(self, left: float, right: float) -> None:
        """Set the wheel speeds, mm/s as counted by the encoders."""
        self.left, self.right = left, right
        true_left, true_right = (speed / 1000 / self.errors.wheel_travel for speed in (left, right))
        # true velocity at these speeds without slip, m/s and rad/s
        self.velocity = (true_left + true_right) / 2, (true_right - true_left) / self.wheels.base_width

    @property
    def docked(self) -> bool:
        """Whether the robot touches its dock. It loses contact when it drives away."""
        return self._dock is not None and abs(self._odometer - self._dock) < CONTACT

    @docked.setter
    def docked(self, on: bool) -> None:
        self._dock = self._odometer if on else None

    @property
    def dropped(self) -> bool:
        """Whether a wheel has dropped."""
        return bool(self.switches & WHEEL_DROPS)

    @property
    def moving(self) -> bool:
        return bool(self.left or self.right)

    def advance(self, duration: int) -> None:
        """duration: ns."""
        if not duration:
            return
        left, right = self.wheels.travel(*self.velocity, duration / SECOND)
        self._odometer += (left + right) / 2
        self._counted_left += left * self.errors.wheel_travel
        self._counted_right += right * self.errors.wheel_travel

    def sample(self, duration: float, charging: bool) -> None:
        """Update `values`, the packet values by name, `duration` (s) after the previous call.

        Distance and angle are not included, since reading them changes them. charging: whether a charger would charge
        the battery.
        """
        left, right = self._counted_left, self._counted_right
        self.distance.total = 1000 * (left + right) / 2
        self.angle.total = degrees((right - left) / self.model.wheel_separation)
        charging = charging and (self.docked or self.charger) and not self.charging_fault
        current = self._use_battery(duration, charging)
        charge = round(self.charge)
        linear, angular = self.velocity
        rate = degrees(self.gyro.read(self.wheels.truth.yaw, duration, False).rate) * self.errors.gyro_sensitivity
        cliffs = [self.cliffs >> bit & 1 for bit in range(len(CLIFFS))]
        self.values.update(
            zip(CLIFFS, cliffs), capacity=CAPACITY, bumps_and_wheel_drops=self.switches,
            buttons=self.buttons & self.model.packets[18].high, infrared=self.infrared,
            # fault, trickle charging, full charging, none
            charging_state=5 if self.charging_fault else (3 if charge >= CAPACITY else 2) if charging else 0,
            charging_sources=2 * self.docked + self.charger,
            voltage=self.voltage or round(1000 * (EMPTY + (FULL - EMPTY) * min(1, charge / CAPACITY))),
            temperature=self.temperature, current=current, charge=charge)
        self.values.update((f'{name}_signal', NO_FLOOR if cliff else FLOOR) for name, cliff in zip(CLIFFS, cliffs))
        if self.model.has_gyro_board:
            signal = max(0, min(1023, round(ADC_ZERO * (1 - rate / self.gyro_range))))
            self.values.update(digital_inputs=PULL_UPS,
                               analog_input=signal if self.gyro_stuck < 0 else self.gyro_stuck)
        if self.model.counts_per_metre:
            self.values.update(
                left_encoder=self._encoder(left), right_encoder=self._encoder(right),
                left_motor_current=150 if self.left else 0, right_motor_current=150 if self.right else 0,
                stasis=int(linear > abs(angular * self.wheels.base_width / 2)))

    def _encoder(self, travel: float) -> int:
        return floor(travel * (self.model.counts_per_metre or 0) + 0.5) & 0xffff

    def _use_battery(self, duration: float, charging: bool) -> int:
        """Charge or discharge the battery for `duration` (s). Returns the current in mA."""
        if charging:
            current = CHARGING if self.charge < CAPACITY else 0
        else:
            current = MOVING if self.moving else RESTING
        self.charge = max(0.0, self.charge + current * duration / 3600)
        return current
