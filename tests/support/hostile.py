"""Files that a stranger may have made to do harm, or that are broken: name -> (words of the refusal, how one is made).

Each maker is given a path, where a small atlas lies, and changes that. All are sealed anew, as a stranger can.
"""

import json
import os
import zlib

import h5py
import numpy as np

from freesweep.query.calibration import ESTIMATES

SECRET = b"not yours"
MAKERS = {}


def hostile(words):
    """Register a maker."""

    def register(maker):
        MAKERS[maker.__name__] = words, maker
        return maker

    return register


def structure(words):
    """A maker that changes the open HDF5 file."""

    def register(change):
        def maker(path):
            with h5py.File(path, "r+", libver="latest") as file:
                change(file)

        MAKERS[change.__name__] = words, maker
        return change

    return register


def content(words):
    """A maker that changes the dataset, which is then written as sweeps write it."""

    def register(change):
        def maker(path):
            import xarray as xr
            from grids import store

            with xr.open_dataset(path, decode_times=False) as opened:
                data = change(opened.load())
            store(data, path)

        MAKERS[change.__name__] = words, maker
        return change

    return register


# --- no files, or of another kind


@hostile("a folder, a pipe or a device")
def folder(path):
    path.unlink()
    path.mkdir()


@hostile("a folder, a pipe or a device")
def pipe_that_never_ends(path):
    path.unlink()
    os.mkfifo(path)


@hostile("a folder, a pipe or a device")
def device_that_never_ends(path):
    path.unlink()
    path.symlink_to("/dev/zero")


@hostile("does not begin as an HDF5 file")
def zero_bytes(path):
    path.write_bytes(b"")


@hostile("does not begin as an HDF5 file")
def text(path):
    path.write_text("alpha, beta\n1, 2\n")


@hostile("does not begin as an HDF5 file")
def pickled(path):
    path.write_bytes(b"\x80\x04cos\nsystem\n(S'touch harm'\ntR.")


@hostile("does not begin as an HDF5 file")
def classic_netcdf(path):
    from scipy.io import netcdf_file

    with netcdf_file(path, "w") as file:
        file.createDimension("alpha", 3)
        file.createVariable("status", "i1", ("alpha",))[:] = 0


@hostile("does not begin as an HDF5 file")
def hdf5_behind_other_bytes(path):
    path.write_bytes(b"#!/bin/sh\n".ljust(512, b"\n") + path.read_bytes())


@hostile("more than any atlas")
def terabytes_of_nothing(path):
    os.truncate(path, 1 << 42)


@hostile("cannot open it")
def half(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


@hostile("cannot open it")
def garbage_behind_the_signature(path):
    path.write_bytes(path.read_bytes()[:8] + np.random.default_rng(1).bytes(5000))


@hostile("texts and references are damaged")
def heap_that_never_ends(path):
    """The HDF5 library takes a free space of no size for ever."""
    content = bytearray(path.read_bytes())
    at = content.index(b"GCOL\x01") + 16
    content[at : at + 16] = bytes(16)
    path.write_bytes(content)


@hostile("texts and references are damaged")
def heap_larger_than_the_file(path):
    content = bytearray(path.read_bytes())
    at = content.index(b"GCOL\x01") + 8
    content[at : at + 8] = (1 << 40).to_bytes(8, "little")
    path.write_bytes(content)


# --- other files


@structure("external storage")
def external_storage(file):
    attrs = dict(file["c01"].attrs)
    del file["c01"]
    secret = os.path.join(os.path.dirname(file.filename), "secret")
    made = file.create_dataset("c01", (1,), "<f8", external=[(secret, 0, 8)])
    made.attrs.update(attrs)


@structure("a link to elsewhere")
def external_link(file):
    file["extra"] = h5py.ExternalLink("other.nc", "/status")


@structure("a link to elsewhere")
def soft_link(file):
    file["extra"] = h5py.SoftLink("/status")


@structure("a virtual dataset")
def virtual_dataset(file):
    layout = h5py.VirtualLayout((2,), "i1")
    layout[:] = h5py.VirtualSource("other.nc", "status", (2,))
    file.create_virtual_dataset("extra", layout)


# --- objects that no atlas has


@structure("a group or a named type")
def group(file):
    file.create_group("inner")


@structure("a group or a named type")
def group_within_itself(file):
    file["again"] = file["/"]


@structure("a group or a named type")
def committed_type(file):
    file["kind"] = np.dtype("<f8")


@structure("holds no plain numbers but")
def variable_of_a_committed_type(file):
    del file["rotation_error"]
    kind = h5py.h5t.IEEE_F32LE.copy()
    kind.commit(file.id, b"kind")
    h5py.h5d.create(file.id, b"rotation_error", kind, h5py.h5s.create_simple((2,)))
    del file["kind"]


@structure("by a second name")
def one_variable_with_two_names(file):
    file["second"] = file["rotation"]


@structure("objects, at most")
def thousands_of_variables(file):
    for k in range(600):
        file[f"v{k}"] = 0.0


@structure("holds no plain numbers but vlen")
def ragged_numbers(file):
    file.create_dataset("extra", (2,), h5py.vlen_dtype(np.float64))[:] = [np.zeros(2), np.zeros(3)]


@structure("holds no plain numbers but compound")
def compound_numbers(file):
    file["extra"] = np.zeros(2, [("a", "f8"), ("b", "i4")])


@structure("holds no plain numbers but reference")
def references(file):
    file.create_dataset("extra", (1,), h5py.ref_dtype)[0] = file["status"].ref


@structure("holds no plain numbers but string")
def texts_for_numbers(file):
    file["extra"] = ["1.0", "2.0"]


@structure("holds no plain numbers but opaque")
def opaque(file):
    file["extra"] = np.zeros(2, "V4")


@structure("holds no plain numbers but enum")
def enumeration(file):
    file["extra"] = np.zeros(2, h5py.enum_dtype({"ok": 0}))


@structure("holds no plain numbers but float")
def numbers_of_16_bits(file):
    file["extra"] = np.zeros(2, "<f2")


@structure("holds nothing")
def null_space(file):
    file["extra"] = h5py.Empty("f8")


# --- sizes


@structure("declares 1,125,899,906,842,624 numbers")
def petabytes_in_kilobytes(file):
    file.create_dataset("extra", (1 << 50,), "f8", chunks=(1 << 16,), compression="gzip")


@structure("chunks, 0 are stored")
def terabytes_in_kilobytes(file):
    file.create_dataset("extra", (1 << 38,), "f8", chunks=(1 << 16,), compression="gzip")


@structure("declares 8,589,934,592 bytes, 0 are stored")
def gigabytes_not_there(file):
    file.create_dataset("extra", (1 << 30,), "f8")


@structure("declares 0 numbers")
def no_numbers(file):
    file.create_dataset("extra", (0, 5), "f8")


@structure("would unpack from")
def deflate_bomb(file):
    made = file.create_dataset("extra", (4096, 1 << 20), "i1", chunks=(1, 1 << 20), compression="gzip")
    packed = zlib.compress(bytes(1 << 20), 9)
    for k in range(4096):
        made.id.write_direct_chunk((k, 0), packed)


@structure("not packed from the 8 bytes that it declares")
def chunk_that_bursts(file):
    made = file.create_dataset("extra", (1,), "f8", chunks=(1,), compression="gzip")
    made.id.write_direct_chunk((0,), zlib.compress(zlib.compress(bytes(1 << 26), 9), 9)[:72])


@structure("packed otherwise than it says")
def chunk_larger_than_itself(file):
    made = file.create_dataset("extra", (1,), "f8", chunks=(1,), compression="gzip")
    made.id.write_direct_chunk((0,), zlib.compress(bytes(1 << 26), 9))


@structure("chunks of 134,217,728 bytes")
def enormous_chunk(file):
    file.create_dataset("extra", (1 << 24,), "f8", chunks=(1 << 24,), compression="gzip")


@structure("allowed is deflate")
def other_filter(file):
    file.create_dataset("extra", data=np.zeros(9), compression="lzf")


@structure("allowed is deflate")
def unknown_filter(file):
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    made.set_chunk((2,))
    made.set_filter(40_000, h5py.h5z.FLAG_OPTIONAL, (1, 2))
    h5py.h5d.create(file.id, b"extra", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple((2,)), made)


@structure("bytes, at most")
def enormous_attribute(file):
    file.attrs["long"] = np.zeros(1 << 18)


@structure("neither one text nor plain numbers")
def attribute_that_refers(file):
    file.attrs["refers"] = file["status"].ref


@structure("neither one text nor plain numbers")
def ragged_attribute(file):
    ragged = np.empty(1, object)
    ragged[0] = np.zeros(2)
    file["status"].attrs.create("ragged", ragged, (1,), h5py.vlen_dtype(np.float64))


@structure("attributes, at most")
def thousands_of_attributes(file):
    for k in range(600):
        file["status"].attrs[f"a{k}"] = 0


@structure("holds texts of more than")
def endless_labels(file):
    file.create_dataset("design", (1,), h5py.string_dtype())[0] = "A" * 100_000


# --- readable, but no atlas


@content("specification_sha256 is missing")
def attribute_missing(data):
    del data.attrs["specification_sha256"]
    return data


@content("accuracy is missing, or no positive number")
def attribute_of_another_type(data):
    return data.assign_attrs(accuracy="high")


@content("strain energy is 'free'")
def unknown_energy(data):
    return data.assign_attrs(energy="free")


@content("characters that cannot be printed")
def words_that_command_terminals(data):
    return data.assign_attrs(title="\x1b]0;harm\x07")


@content("not what an atlas measures of itself")
def measurement_nested_without_end(data):
    return data.assign_attrs(interpolation_measured="[" * 100_000)


@content("not what an atlas measures of itself")
def measurement_of_other_form(data):
    return data.assign_attrs(interpolation_measured=json.dumps({"estimates": ESTIMATES, "variables": {"rotation": 1}}))


@content("status is missing")
def no_statuses(data):
    return data.drop_vars("locked_status")


@content("rotation has no rotation_error")
def no_bound(data):
    return data.drop_vars("rotation_error")


@content("rotation varies along pressure, alpha")
def exchanged_dimensions(data):
    return data.assign(rotation=data["rotation"].transpose("pressure", ...))


@content("status varies along")
def missing_dimension(data):
    return data.assign(status=data["status"].isel(pressure=0, drop=True))


@content("dimension 'sideways' is no axis")
def unknown_axis(data):
    return data.rename(pressure="sideways")


@content("'pressure' declares 8 bytes, 0 are stored")
def axis_without_values(data):
    return data.drop_vars("pressure")


@content("pressure has values that are no finite numbers")
def nan_on_an_axis(data):
    return with_pressures(data, [0.0, np.nan])


@content("pressure has values that are no finite numbers")
def whole_numbers_on_an_axis(data):
    return with_pressures(data, [0, 1])


@content("the values of pressure do not increase")
def unsorted_axis(data):
    return with_pressures(data, [1e5, 0.0])


@content("the values of pressure do not increase")
def axis_with_a_repeat(data):
    return with_pressures(data, [1e5, 1e5])


@content("length has values that are no finite numbers")
def endless_tube(data):
    data["length"].values[...] = np.inf
    return data


@content("radius is missing among its coordinates")
def coordinate_missing(data):
    return data.drop_vars("radius")


@content("rotation is in 'rad', in atlases it is in 'degree'")
def other_units(data):
    data["rotation"].attrs["units"] = "rad"
    return data


@content("by which readers change numbers")
def numbers_that_are_scaled(data):
    data["rotation"].attrs["scale_factor"] = 2.0
    return data


@content("rotation is of type int64")
def whole_numbers(data):
    return data.assign(rotation=data["rotation"].fillna(0).astype(np.int64).assign_attrs(data["rotation"].attrs))


@content("status is of type float64")
def statuses_that_are_no_labels(data):
    return data.assign(status=data["status"] * 1.0)


@content("status has labels outside its table (0 to 9): 0 to 77")
def status_outside_the_table(data):
    data["status"].values.flat[-1] = 77
    return data


@content("stable has labels outside its table (0 to 1): -1 to 1")
def flag_outside_the_table(data):
    data["stable"].values.flat[0] = -1
    return data


@content("'mine' is unknown to this version")
def unknown_variable(data):
    return data.assign(mine=data["rotation"])


def with_pressures(data, values):
    """The dataset with other pressures."""
    return data.assign_coords(pressure=("pressure", values, data["pressure"].attrs))
