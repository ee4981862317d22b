"""Walk an agent through a room in the Gymnasium environment.

python examples/10_agent.py [OUT] [STEPS]
"""

import sys

import world2minecraft as w2m

source = sys.argv[1] if len(sys.argv) > 1 else "OUT"
steps = int(sys.argv[2]) if len(sys.argv) > 2 else 50

env = w2m.make_env(source)
observation, info = env.reset(seed=0)
print("task:", info["instruction"])

total = 0.0
for _ in range(steps):
    action = env.action_space.sample()  # Your policy goes here.
    observation, reward, terminated, truncated, info = env.step(action)
    total += float(reward)
    if terminated or truncated:
        break
print(f"reward {total:.2f}; {info['distance_m']:.1f} m to the goal")
