"""The store of a data set: WebDataset shards with a Parquet index.

A crash during writing loses at most one sample. All sizes are checked during reading.
"""

from world2minecraft.minecraftocc.store.folder import read_classes, read_meta, shard_name
from world2minecraft.minecraftocc.store.reader import OccStore, open_store
from world2minecraft.minecraftocc.store.sample_files import (
    FineTable,
    SampleFiles,
    pack_sample,
    unpack_sample,
)
from world2minecraft.minecraftocc.store.shard import ShardWriter
from world2minecraft.minecraftocc.store.verify import VerifyReport, verify_store
from world2minecraft.minecraftocc.store.writer import write_store

__all__ = [
    "FineTable",
    "OccStore",
    "SampleFiles",
    "ShardWriter",
    "VerifyReport",
    "open_store",
    "pack_sample",
    "read_classes",
    "read_meta",
    "shard_name",
    "unpack_sample",
    "verify_store",
    "write_store",
]
