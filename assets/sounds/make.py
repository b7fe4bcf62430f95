#!/usr/bin/env python3
"""Writes alarm.wav and reminder.wav: two tones each, falling for an alarm, rising for a reminder."""

import math
import struct
import wave

RATE = 11_025


def tone(hertz, seconds, loudness):
    count = int(RATE * seconds)
    for index in range(count):
        at = index / RATE
        # A soft start, and an end that dies away: no clicks.
        envelope = min(1.0, at / 0.008) * math.cos(math.pi / 2 * index / count) ** 1.5
        wave_form = math.sin(2 * math.pi * hertz * at) + 0.25 * math.sin(4 * math.pi * hertz * at)
        yield int(32_767 * loudness * envelope * wave_form / 1.25)


def write(name, tones):
    samples = [sample for tone_ in tones for sample in tone(*tone_)]
    with wave.open(name, "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(RATE)
        out.writeframes(struct.pack(f"<{len(samples)}h", *samples))


write("alarm.wav", [(988, 0.14, 0.5), (740, 0.26, 0.5)])
write("reminder.wav", [(587, 0.12, 0.3), (784, 0.24, 0.3)])
