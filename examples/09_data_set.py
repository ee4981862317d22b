"""Build a small occupancy data set from generated houses, and look at one sample.

python examples/09_data_set.py [DATA] [IMAGES]
"""

import sys

import numpy as np
from PIL import Image

import world2minecraft as w2m


def main() -> None:
    folder = sys.argv[1] if len(sys.argv) > 1 else "DATA"
    images = int(sys.argv[2]) if len(sys.argv) > 2 else 40

    data = w2m.build_dataset(folder, houses=2, images=images, progress=print)
    sample = data[0]
    labels = sample.occ.labels

    print(data, data.keys()[:3])
    print("picture", sample.colour.shape, "depth up to", f"{sample.depth_m.max():.1f} m")
    print("cells", labels.shape, "occupied", int(np.count_nonzero((labels > 0) & (labels < 255))))
    Image.fromarray(sample.colour).save("sample.png")


if __name__ == "__main__":  # The processes that share the work import this file, too.
    main()
