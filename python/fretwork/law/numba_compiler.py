"""Ahead-of-time compilation by numba: everything that depends on its version.

What is compiled is the same on every machine: one processor model, no fast-math, no contraction to fused operations, as rustc
and cc do by default. Functions that a law calls are compiled with it.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import math
import platform
from types import FunctionType, ModuleType
from typing import Any, cast

from fretwork._errors import missing

from . import source
from .results import Attraction, Conductance, Friction, Spring, Traction
from .source import LawError

#: The version whose private interfaces are used here, as `pyfretwork[laws]` installs it.
NUMBA = "0.68.0"

#: Processor that laws are compiled for: the base of the architecture, as for laws in Rust and C.
PROCESSORS = {"x86_64": "x86-64", "AMD64": "x86-64"}

_RESULTS = (Friction, Spring, Traction, Attraction, Conductance)


def imported(name: str) -> Any:
    """A module of numba or llvmlite: untyped, as their interfaces used here are."""
    return importlib.import_module(name)


def require_numba() -> None:
    """Refuses another numba than the one this module is written for.

    Raises:
        MissingPackageError: if there is none.
        LawError: with the command that installs it.
    """
    try:
        found = importlib.metadata.version("numba")
    except importlib.metadata.PackageNotFoundError:
        raise missing("numba", "laws", "compiling a law written in Python") from None
    if found != NUMBA:
        raise LawError(
            f"laws in Python are compiled by numba {NUMBA}, and numba {found} is installed, whose internals differ: "
            f"pip install numba=={NUMBA}"
        )
    if imported("numba").config.DISABLE_JIT:
        raise LawError("NUMBA_DISABLE_JIT is set, so that numba compiles nothing; unset it to build laws")


class Compiler:
    """Functions compiled into one object file."""

    def __init__(self) -> None:
        require_numba()
        llvm = imported("llvmlite.binding")
        cpu_target = imported("numba.core.registry").cpu_target
        llvm.initialize_all_targets()
        llvm.initialize_all_asmprinters()
        self._llvm = llvm
        self._typing = cpu_target.typing_context
        cpu = PROCESSORS.get(platform.machine(), "generic")
        self._context = cpu_target.target_context.with_aot_codegen("law", cpu_name=cpu)
        self._library = self._context.codegen().create_library("law")
        self._flags = imported("numba.core.compiler").Flags()
        self._flags.no_compile = True
        self._flags.no_cpython_wrapper = True
        self._flags.no_cfunc_wrapper = True
        self._flags.error_model = "numpy"
        self._compiled: dict[int, tuple[Any, Any]] = {}
        self._active: list[FunctionType] = []
        #: fields of results that the compiled functions give, by result
        self.given: dict[type, set[str]] = {result: set() for result in _RESULTS}
        #: files of the functions that the user wrote, for messages
        self.files: set[str] = set()

    # From functions in Python to what numba takes.

    def function(self, value: Any) -> Any:
        """A function that numba compiles together with those it calls."""
        kept = self._compiled.get(id(value))
        if kept is not None:
            return kept[0]
        if value in self._active:
            raise source.at(value, f"`{value.__name__}` calls itself; write a loop in place of the recursion")
        njit = imported("numba").njit
        self._active.append(value)
        self.files.add(value.__code__.co_filename)
        try:
            options = {"error_model": "numpy", "forceinline": True, "boundscheck": True}
            dispatcher = njit(**options, no_cpython_wrapper=True, no_cfunc_wrapper=True)(self._rebuilt(value))
        finally:
            self._active.pop()
        self._compiled[id(value)] = (dispatcher, value)
        return dispatcher

    def _adapted(self, value: Any, names: set[str]) -> Any:
        """What stands in place of a global: `names` are those that the code looks up, in modules too."""
        if isinstance(value, type) and value in _RESULTS:
            return self._result(value)
        if isinstance(value, FunctionType):
            source.check(value)
            return self.function(value)
        if isinstance(value, ModuleType) and value.__name__.split(".")[0] not in source.KNOWN_MODULES:
            return self._module(value, names)
        return value

    def _module(self, module: ModuleType, names: set[str]) -> ModuleType:
        """A module with the attributes that a law uses, functions in Python compiled."""
        kept = self._compiled.get(id(module))
        stand_in = kept[0] if kept is not None else ModuleType(module.__name__)
        self._compiled[id(module)] = (stand_in, module)
        for name in sorted(names):
            if name not in vars(stand_in) and hasattr(module, name):
                setattr(stand_in, name, self._adapted(getattr(module, name), names))
        return cast(ModuleType, stand_in)

    def _rebuilt(self, function: FunctionType) -> FunctionType:
        """The same code with compiled functions in place of those in Python, and all arguments by position."""
        code = function.__code__
        used = source.names_used(code)
        world = {name: self._adapted(v, used) if name in used else v for name, v in function.__globals__.items()}
        cells = None
        if function.__closure__ is not None:
            from types import CellType

            cells = tuple(CellType(self._adapted(cell.cell_contents, used)) for cell in function.__closure__)
        positional = code.replace(co_argcount=code.co_argcount + code.co_kwonlyargcount, co_kwonlyargcount=0, co_posonlyargcount=0)
        law = any(not isinstance(d, (int, float)) for d in (*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()))
        defaults = None if law else function.__defaults__
        rebuilt = FunctionType(positional, world, function.__name__, defaults, cells)
        # The names of modules reach the symbols; `__main__` and an imported file give the same
        # code.
        rebuilt.__module__ = "law"
        return rebuilt

    def _result(self, result: Any) -> Any:
        """A function that makes a result; numba does not know defaults of named tuples. It notes which fields are given."""
        kept = self._compiled.get(id(result))
        if kept is not None:
            return kept[0]
        types, overload = imported("numba.core.types"), imported("numba.extending").overload
        fields, defaults = result._fields, result._field_defaults
        heads = ", ".join(f"{f}={defaults[f]!r}" if f in defaults else f for f in fields)
        values = ", ".join(f"float({f})" for f in fields)
        text = (
            f"def {result.__name__}({heads}):\n    pass\n"
            f"def build({heads}):\n    return result({values})\n"
            f"def typing({heads}):\n    note(dict({', '.join(f'{f}={f}' for f in fields)}))\n    return build\n"
        )

        def note(seen: dict[str, Any]) -> None:
            self.given[result] |= {f for f, t in seen.items() if isinstance(t, types.Type) and not isinstance(t, types.Omitted)}

        world: dict[str, Any] = {"result": result, "note": note, "__name__": "law"}
        exec(text, world)
        stub = world[result.__name__]
        overload(stub, jit_options={"error_model": "numpy", "forceinline": True})(world["typing"])
        self._compiled[id(result)] = (stub, result)
        return stub

    # Compilation.

    def returned(self, function: FunctionType, integers: tuple[str, ...] = ()) -> Any:
        """Compiles a function of numbers and returns the numba type of what it returns.

        Raises:
            LawError: with the line that cannot be compiled.
        """
        errors, types = imported("numba.core.errors"), imported("numba.core.types")
        dispatcher = self.function(function)
        names = source.signature(function)
        argtypes = tuple(types.int64 if name in integers else types.float64 for name in names)
        try:
            dispatcher.compile(argtypes)
            return dispatcher.overloads[argtypes].signature.return_type
        except errors.NumbaError as e:
            from .explain import explain

            raise explain(e, function, self.files) from None

    def add(self, code: str, symbol: str, names: dict[str, Any], pointers: int, numbers: tuple[str, ...]) -> None:
        """Compiles generated code into the object under a symbol: a count, numbers (`d` or `i`), then pointers to doubles."""
        types, compile_extra = imported("numba.core.types"), imported("numba.core.compiler").compile_extra
        world: dict[str, Any] = {"isfinite": math.isfinite, "__name__": "law", **names}
        exec(compile(code, f"<{symbol}>", "exec"), world)
        kinds = {"d": types.float64, "i": types.int64}
        argtypes = (*(kinds[k] for k in numbers), *[types.CPointer(types.float64)] * pointers)
        with imported("numba.core.compiler_lock").global_compiler_lock:
            self._typing.refresh()
            self._context.refresh()
            compiled = compile_extra(self._typing, self._context, world[symbol], argtypes, None, self._flags, {}, library=self._library)
            self._library.get_function(compiled.fndesc.llvm_func_name).name = f"fretwork_{symbol}"

    def object(self) -> bytes:
        """The object file: position-independent, with the added symbols alone."""
        llvm = self._llvm
        with imported("numba.core.compiler_lock").global_compiler_lock:
            self._library.finalize()
            module = self._library._final_module
            for function in module.functions:
                if not function.is_declaration and not function.name.startswith("fretwork_"):
                    function.linkage = llvm.Linkage.internal
            # Places for numba's own Python objects, which nothing here uses; their names count
            # compilations.
            for variable in module.global_variables:
                if not variable.is_declaration:
                    variable.linkage = llvm.Linkage.internal
            machine = self._library.codegen._tm
            passes = llvm.create_new_module_pass_manager()
            passes.add_global_dead_code_eliminate_pass()
            passes.run(module, llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=3)))
            return bytes(machine.emit_object(module))
