from pneutouch.api.comparison import Comparison as Comparison
from pneutouch.api.comparison import compare as compare
from pneutouch.api.design import Design as Design
from pneutouch.api.design import load as load
from pneutouch.api.listing import Listing as Listing
from pneutouch.api.listing import designs as designs
from pneutouch.api.listing import materials as materials
from pneutouch.api.listing import printers as printers
from pneutouch.api.measuring import calibrate as calibrate
from pneutouch.api.measuring import characterize as characterize
from pneutouch.api.measuring import plan as plan
from pneutouch.api.measuring import scan as scan
from pneutouch.api.measuring import simulate as simulate
from pneutouch.api.prediction import FigureValue as FigureValue
from pneutouch.api.prediction import PredictedState as PredictedState
from pneutouch.api.prediction import Prediction as Prediction
from pneutouch.api.results import CheckResult as CheckResult
from pneutouch.api.results import Result as Result
from pneutouch.api.search import Selection as Selection
from pneutouch.api.search import select as select
from pneutouch.api.search import sweep as sweep
from pneutouch.errors import ComputationError as ComputationError
from pneutouch.errors import InputError as InputError
from pneutouch.errors import PneutouchError as PneutouchError
from pneutouch.errors import RuleBrokenError as RuleBrokenError

__version__: str
